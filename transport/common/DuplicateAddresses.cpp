#include "common/DuplicateAddresses.h"

#include <algorithm>

namespace Rabit
{

namespace
{

bool IsElsewhere(const PeerPlace &peer, const std::vector<HostNetwork> &usable)
{
    return std::any_of(
        peer.begin(), peer.end(),
        [&](const std::string &address)
        {
            const auto isOurs = [&](const HostNetwork &network) { return network.Address == address; };
            const auto isNear = [&](const HostNetwork &network) { return network.Contains(address); };
            return std::none_of(usable.begin(), usable.end(), isOurs) &&
                   std::any_of(usable.begin(), usable.end(), isNear);
        });
}

}  // namespace

void DuplicateAddresses::Look(const std::vector<HostNetwork> &usable, const std::vector<PeerPlace> &peers)
{
    std::erase_if(_found,
                  [&](const HostNetwork &found)
                  {
                      return std::none_of(usable.begin(), usable.end(),
                                          [&](const HostNetwork &network) { return network.IsSame(found); });
                  });
    for (const PeerPlace &peer : peers)
    {
        for (const HostNetwork &network : usable)
        {
            const bool isItsToo = std::find(peer.begin(), peer.end(), network.Address) != peer.end();
            if (isItsToo && IsElsewhere(peer, usable) && !Has(network))
            {
                _found.push_back(network);
            }
        }
    }
}

bool DuplicateAddresses::Has(const HostNetwork &network) const
{
    return std::any_of(_found.begin(), _found.end(),
                       [&](const HostNetwork &found) { return found.IsSame(network); });
}

}  // namespace Rabit
