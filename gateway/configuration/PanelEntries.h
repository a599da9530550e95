#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include "configuration/YamlMap.h"

namespace Rabit
{

// Reads the section `foxglove` of a configuration file into `config`.
void ReadPanels(const YamlMap &map, GatewayConfig &config);

}  // namespace Rabit
