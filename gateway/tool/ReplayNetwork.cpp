#include "ReplayNetwork.h"

namespace Rabit::Tool
{

GatewayConfig ReplayNetwork(GatewayConfig config, const CommonOptions &options,
                            const std::set<std::string> &recordedDomains)
{
    const int domain = options.Node.Domain;
    const bool isOtherDomain =
        domain >= 0 && !recordedDomains.empty() && recordedDomains.count(std::to_string(domain)) == 0;
    if (options.Interfaces.empty() && !isOtherDomain)
    {
        config.Interfaces = {"127.0.0.1"};
        config.Peers.clear();
        config.BackendConfig.clear();
    }
    return config;
}

}  // namespace Rabit::Tool
