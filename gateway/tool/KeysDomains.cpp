#include "KeysDomains.h"

#include <rabit/gateway/LoadGatewayConfig.h>

#include "keys/KeysError.h"

namespace Rabit::Tool
{

GatewayConfig ConfigForKeys(const std::string &file, const std::string &node)
{
    return LoadGatewayConfig(file, node, [](const std::string &) { return std::string(); });
}

int DomainOf(const Keys::NodeKeys &keys)
{
    const auto &rules = keys.Permissions().Rules;
    const bool isOne = !rules.empty() && rules.front().Domains.size() == 1 &&
                       rules.front().Domains.front().first == rules.front().Domains.front().second;
    return isOne ? rules.front().Domains.front().first : -1;
}

std::map<int, std::size_t> DomainsOf(const Keys::FleetKeys &fleet)
{
    std::map<int, std::size_t> domains;
    for (const std::string &node : fleet.Nodes())
    {
        try
        {
            ++domains[DomainOf(Keys::NodeKeys(fleet.FolderOf(node), Keys::PrivateKeyPlace::HereOrOnNode))];
        }
        catch (const Keys::KeysError &)
        {
            // `rabit keys check` reports it.
        }
    }
    domains.erase(-1);
    return domains;
}

}  // namespace Rabit::Tool
