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

// Tells whether a datagram to a multicast group came by an interface that a session does not use. Linux gives
// such a datagram to every socket of the group's port (IP_MULTICAST_ALL, ip(7)). It is enough that any socket
// of the host has joined the group on the interface by which the datagram came. Two sessions on two
// interfaces of one host would hear the networks of both. Datagrams of other networks may come: routers carry
// groups, too.
class OwnNetworks
{
public:
    // `addresses`: of the interfaces that were named; empty: all are used.
    OwnNetworks(const std::vector<std::string> &addresses, const std::vector<HostNetwork> &all)
    {
        for (const HostNetwork &network : all)
        {
            const bool isNamed =
                std::find(addresses.begin(), addresses.end(), network.Address) != addresses.end();
            if (!addresses.empty() && network.Number())
            {
                (isNamed ? _own : _others).emplace_back(*network.Number() & network.Mask, network.Mask);
            }
        }
    }

    bool MayComeFrom(const Rtps::HostAddress &host) const
    {
        const std::uint32_t address = std::uint32_t{host[0]} << 24 | std::uint32_t{host[1]} << 16 |
                                      std::uint32_t{host[2]} << 8 | std::uint32_t{host[3]};
        return !Has(_others, address) || Has(_own, address);
    }

private:
    using Networks = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // number and mask, in host order

    static bool Has(const Networks &networks, std::uint32_t address)
    {
        return std::any_of(networks.begin(), networks.end(),
                           [address](const auto &network)
                           { return (address & network.second) == network.first; });
    }

    Networks _own;
    Networks _others;
};

}  // namespace Rabit
