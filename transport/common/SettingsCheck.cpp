#include "common/SettingsCheck.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>

namespace Rabit
{

namespace
{

constexpr std::size_t MaxNodeName = 200;
constexpr int MaxDomain = 232;

std::string ToText(const sockaddr *address)
{
    const auto *ipv4 = reinterpret_cast<const sockaddr_in *>(address);
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &ipv4->sin_addr, text, sizeof text);
    return text;
}

// An IPv4 address of this host.
struct HostAddress
{
    std::string Interface;
    std::string Text;
    bool IsLoopback = false;

    bool IsCalled(const std::string &name) const { return name == Interface || name == Text; }
};

// Empty if they cannot be listed.
std::optional<std::vector<HostAddress>> AddressesOfThisHost()
{
    ifaddrs *head = nullptr;
    if (getifaddrs(&head) != 0)
    {
        return std::nullopt;
    }
    const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> list(head, &freeifaddrs);
    std::vector<HostAddress> addresses;
    for (const ifaddrs *entry = head; entry != nullptr; entry = entry->ifa_next)
    {
        if (entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET)
        {
            addresses.push_back(
                {entry->ifa_name, ToText(entry->ifa_addr), (entry->ifa_flags & IFF_LOOPBACK) != 0});
        }
    }
    return addresses;
}

}  // namespace

void CheckSettings(const TransportSettings &settings)
{
    if (settings.Node.empty() || settings.Node.size() > MaxNodeName)
    {
        throw TransportError(
            "the node name must have 1 to 200 bytes, not " + std::to_string(settings.Node.size()), "node");
    }
    if (settings.Node.find('\0') != std::string::npos)
    {
        throw TransportError("the node name contains a zero byte", "node");
    }
    if (settings.Domain < 0 || settings.Domain > MaxDomain)
    {
        throw TransportError("the domain must be 0 to 232, not " + std::to_string(settings.Domain), "domain");
    }
    if (settings.MaxDatagram < TransportSettings::SmallestDatagram ||
        settings.MaxDatagram > TransportSettings::LargestDatagram)
    {
        throw TransportError("the largest datagram must be " +
                                 std::to_string(TransportSettings::SmallestDatagram) + " to " +
                                 std::to_string(TransportSettings::LargestDatagram) + " bytes, not " +
                                 std::to_string(settings.MaxDatagram),
                             "max_datagram");
    }
    if (settings.AnnouncementPeriod.count() <= 0 || settings.Lease <= settings.AnnouncementPeriod)
    {
        throw TransportError("the lease must be longer than the announcement period, and both positive",
                             "lease");
    }
}

void CheckQos(const TopicDescription &topic, const TopicQos &qos)
{
    constexpr int DeepestHistory = 1000000;
    if (qos.Depth < 1 || qos.Depth > DeepestHistory)
    {
        throw TransportError("the depth of topic " + topic.Name + " must be 1 to 1000000, not " +
                             std::to_string(qos.Depth));
    }
}

std::vector<std::string> ResolveInterfaces(const std::vector<std::string> &interfaces)
{
    if (interfaces.empty())
    {
        return {};
    }
    const auto host = AddressesOfThisHost();
    if (!host)
    {
        throw TransportError("the network interfaces of this host cannot be listed", "interfaces");
    }
    std::vector<std::string> addresses;
    for (const auto &wanted : interfaces)
    {
        bool found = false;
        for (const HostAddress &address : *host)
        {
            if (!address.IsCalled(wanted))
            {
                continue;
            }
            found = true;
            if (std::find(addresses.begin(), addresses.end(), address.Text) == addresses.end())
            {
                addresses.push_back(address.Text);
            }
        }
        if (!found)
        {
            throw TransportError(
                "this host has no network interface with an IPv4 address that is called " + wanted,
                "interfaces");
        }
    }
    return addresses;
}

std::vector<std::string> FindAddresses(const std::vector<std::string> &interfaces)
{
    std::vector<std::string> addresses;
    for (const HostAddress &address : AddressesOfThisHost().value_or(std::vector<HostAddress>()))
    {
        const bool wanted =
            interfaces.empty() ? !address.IsLoopback
                               : std::any_of(interfaces.begin(), interfaces.end(),
                                             [&](const std::string &name) { return address.IsCalled(name); });
        if (wanted)
        {
            addresses.push_back(address.Text);
        }
    }
    std::sort(addresses.begin(), addresses.end());
    return addresses;
}

PeerAddress ResolvePeer(const std::string &peer)
{
    PeerAddress result;
    std::string host = peer;
    if (const auto colon = peer.find(':'); colon != std::string::npos)
    {
        host = peer.substr(0, colon);
        const char *begin = peer.data() + colon + 1;
        const char *end = peer.data() + peer.size();
        const auto [stop, error] = std::from_chars(begin, end, result.Port);
        if (error != std::errc() || stop != end || result.Port == 0)
        {
            throw TransportError("the peer " + peer + " is not of the form host or host:port", "peers");
        }
    }
    addrinfo hints{};
    hints.ai_family = AF_INET;
    hints.ai_socktype = SOCK_DGRAM;
    addrinfo *head = nullptr;
    if (host.empty() || getaddrinfo(host.c_str(), nullptr, &hints, &head) != 0 || head == nullptr)
    {
        throw TransportError("the peer " + peer + " has no IPv4 address", "peers");
    }
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> list(head, &freeaddrinfo);
    result.Address = ToText(head->ai_addr);
    return result;
}

}  // namespace Rabit
