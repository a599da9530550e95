// The IPv4 networks that this host has.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace Rabit
{

// One address of an interface, or an interface without any. An interface with several addresses has several
// entries.
struct HostNetwork
{
    unsigned Index = 0;  // the kernel's index of the interface; a new interface of the same name gets another
    std::string Interface;   // name
    std::string Label;       // the name by which this address is listed: the interface's, or `eth0:1`
    std::string Address;     // IPv4, dotted; empty: none
    std::uint32_t Mask = 0;  // of the address, in host order
    bool Up = false;         // switched on
    bool Running = false;    // and with a carrier
    bool Multicast = false;
    bool Loopback = false;

    bool IsCalled(const std::string &name) const
    {
        return name == Interface || name == Label || (!Address.empty() && name == Address);
    }
    // Same address on the same interface: sockets opened on it work again when it returns.
    bool IsSame(const HostNetwork &other) const { return Index == other.Index && Address == other.Address; }
    // The address as a number, in host order; empty: none.
    std::optional<std::uint32_t> Number() const;
    // True if the address belongs to this network, by its mask. False if it does not parse.
    bool Contains(const std::string &address) const;
};

// `eth0 10.0.0.1`, for people.
std::string Describe(const HostNetwork &network);
// All of them, separated by commas; `none` if there is none.
std::string Describe(const std::vector<HostNetwork> &networks);

// The networks of this host now, in the order of their interfaces. nullopt: they cannot be listed now, as
// without a free descriptor; there may be some.
std::optional<std::vector<HostNetwork>> ListHostNetworks();

}  // namespace Rabit
