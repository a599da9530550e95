#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/HostNetworks.h"
#include "common/Rtps.h"

namespace Rabit
{

// Tells whether a datagram to a multicast group came by one of the interfaces that a session uses. Linux
// gives such a datagram to every socket of the group's port, if any socket of the host has joined the group
// on the interface by which it came (IP_MULTICAST_ALL, ip(7)). Two sessions on two interfaces of one host
// would hear the networks of both.
class OwnNetworks
{
public:
    // `addresses`: of the interfaces that were named; empty: all are used. Everything may come by an interface
    // whose mask tells no neighbours, as that of a modem.
    OwnNetworks(const std::vector<std::string> &addresses, const std::vector<HostNetwork> &all)
    {
        constexpr std::uint32_t alone = 0xffffffff;
        for (const HostNetwork &network : all)
        {
            const bool isNamed =
                std::find(addresses.begin(), addresses.end(), network.Address) != addresses.end();
            if (isNamed && network.Number())
            {
                const std::uint32_t mask = network.Mask == alone ? 0 : network.Mask;
                _networks.emplace_back(*network.Number() & mask, mask);
            }
        }
    }

    bool MayComeFrom(const Rtps::HostAddress &host) const
    {
        const std::uint32_t address = std::uint32_t{host[0]} << 24 | std::uint32_t{host[1]} << 16 |
                                      std::uint32_t{host[2]} << 8 | std::uint32_t{host[3]};
        return _networks.empty() || std::any_of(_networks.begin(), _networks.end(),
                                                [address](const auto &network)
                                                { return (address & network.second) == network.first; });
    }

private:
    std::vector<std::pair<std::uint32_t, std::uint32_t>> _networks;  // number and mask, in host order
};

}  // namespace Rabit
