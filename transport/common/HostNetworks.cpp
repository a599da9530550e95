#include "common/HostNetworks.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <tuple>

namespace Rabit
{

namespace
{

std::optional<std::uint32_t> Parse(const std::string &address)
{
    in_addr parsed{};
    if (inet_pton(AF_INET, address.c_str(), &parsed) != 1)
    {
        return std::nullopt;
    }
    return ntohl(parsed.s_addr);
}

const in_addr &AddressOf(const sockaddr *address)
{
    return reinterpret_cast<const sockaddr_in *>(address)->sin_addr;
}

HostNetwork ToNetwork(const ifaddrs &entry)
{
    HostNetwork network;
    network.Label = entry.ifa_name;
    network.Interface = network.Label.substr(0, network.Label.find(':'));
    network.Index = if_nametoindex(network.Interface.c_str());
    network.Up = (entry.ifa_flags & IFF_UP) != 0;
    network.Running = network.Up && (entry.ifa_flags & IFF_RUNNING) != 0;
    network.Multicast = (entry.ifa_flags & IFF_MULTICAST) != 0;
    network.Loopback = (entry.ifa_flags & IFF_LOOPBACK) != 0;
    if (entry.ifa_addr->sa_family == AF_INET)
    {
        char text[INET_ADDRSTRLEN] = "";
        inet_ntop(AF_INET, &AddressOf(entry.ifa_addr), text, sizeof text);
        network.Address = text;
        network.Mask = entry.ifa_netmask != nullptr ? ntohl(AddressOf(entry.ifa_netmask).s_addr) : ~0u;
    }
    return network;
}

}  // namespace

std::optional<std::uint32_t> HostNetwork::Number() const
{
    return Parse(Address);
}

bool HostNetwork::Contains(const std::string &address) const
{
    const auto own = Parse(Address);
    const auto other = Parse(address);
    return own && other && (*own & Mask) == (*other & Mask);
}

std::string Describe(const HostNetwork &network)
{
    return network.Label + (network.Address.empty() ? "" : " " + network.Address);
}

std::string Describe(const std::vector<HostNetwork> &networks)
{
    std::string text;
    for (const HostNetwork &network : networks)
    {
        text += (text.empty() ? "" : ", ") + Describe(network);
    }
    return text.empty() ? "none" : text;
}

std::optional<std::vector<HostNetwork>> ListHostNetworks()
{
    ifaddrs *head = nullptr;
    if (getifaddrs(&head) != 0)
    {
        return std::nullopt;
    }
    const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> list(head, &freeifaddrs);
    std::vector<HostNetwork> networks;
    std::vector<HostNetwork> bare;
    for (const ifaddrs *entry = head; entry != nullptr; entry = entry->ifa_next)
    {
        if (entry->ifa_addr == nullptr)
        {
            continue;
        }
        if (entry->ifa_addr->sa_family == AF_INET)
        {
            networks.push_back(ToNetwork(*entry));
        }
        else if (entry->ifa_addr->sa_family == AF_PACKET)
        {
            bare.push_back(ToNetwork(*entry));
        }
    }
    const auto hasAddress = [addressed = networks](const HostNetwork &network)
    {
        return std::any_of(addressed.begin(), addressed.end(),
                           [&](const HostNetwork &other) { return other.Interface == network.Interface; });
    };
    std::remove_copy_if(bare.begin(), bare.end(), std::back_inserter(networks), hasAddress);
    std::sort(networks.begin(), networks.end(),
              [](const HostNetwork &a, const HostNetwork &b)
              { return std::tie(a.Index, a.Address) < std::tie(b.Index, b.Address); });
    return networks;
}

}  // namespace Rabit
