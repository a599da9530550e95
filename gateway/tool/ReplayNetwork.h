#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <set>
#include <string>

#include "CommonOptions.h"

namespace Rabit::Tool
{

// The network for a replay: loopback alone, whatever the file of `config` says, unless the command line names
// interfaces, or a domain in which nothing of the recording was recorded. This keeps people in the field from
// taking a replay for the fleet.
GatewayConfig ReplayNetwork(GatewayConfig config, const CommonOptions &options,
                            const std::set<std::string> &recordedDomains);

}  // namespace Rabit::Tool
