#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include "configuration/YamlMap.h"

namespace Rabit
{

// Reads the section `parameters` of a configuration file into `config`.
void ReadParameters(const YamlMap &map, GatewayConfig &config);

}  // namespace Rabit
