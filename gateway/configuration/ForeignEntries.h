#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/LoadGatewayConfig.h>

#include "configuration/YamlMap.h"

namespace Rabit
{

// Reads the section `foreign` of a configuration file into `config`.
void ReadForeign(const YamlMap &map, GatewayConfig &config);

// Checks the `foreign` rules: each alone, against one another, and against `publish` and `subscribe`.
// Throws ConfigError.
void CheckForeign(const GatewayConfig &config, const TypeCheck &whyNoType);

}  // namespace Rabit
