#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <set>
#include <string>

#include "CommonOptions.h"

namespace Rabit::Tool
{

// Where a recording is played: on loopback alone, whatever the file of `config` says, unless the command line
// names interfaces, or a domain in which nothing of it was recorded. So that nobody in the field takes it for
// what is there.
GatewayConfig ReplayNetwork(GatewayConfig config, const CommonOptions &options,
                            const std::set<std::string> &recordedDomains);

}  // namespace Rabit::Tool
