#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include "configuration/YamlMap.h"

namespace Rabit
{

// The section `foxglove` of a configuration file.
void ReadPanels(const YamlMap &map, GatewayConfig &config);

}  // namespace Rabit
