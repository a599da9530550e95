#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/LoadGatewayConfig.h>

#include "configuration/YamlMap.h"

namespace Rabit
{

// The section `foreign` of a configuration file.
void ReadForeign(const YamlMap &map, GatewayConfig &config);

// What is wrong with the rules about programs that are no nodes, and between them and the others. Throws
// ConfigError.
void CheckForeign(const GatewayConfig &config, const TypeCheck &whyNoType);

}  // namespace Rabit
