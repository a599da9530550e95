#include "common/SettingsCheck.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <rabit/transport/FleetMember.h>

#include <string>

#include "common/PeerAddress.h"

namespace Rabit
{

namespace
{

constexpr std::size_t MaxNodeName = 200;
constexpr int MaxDomain = 232;

bool IsIpv6(const std::string &text)
{
    in6_addr address{};
    return inet_pton(AF_INET6, text.substr(0, text.find('%')).c_str(), &address) == 1;
}

// True if `text` is an address, or could be the name of a Linux interface.
bool IsInterface(const std::string &text)
{
    if (LooksLikeAddress(text))
    {
        return IsAddress(text);
    }
    return !text.empty() && text.size() < IFNAMSIZ && !IsIpv6(text) &&
           text.find_first_of(std::string("/ \t\r\n\0", 6)) == std::string::npos;
}

}  // namespace

std::vector<SettingsProblem> FindImpossible(const TransportSettings &settings)
{
    std::vector<SettingsProblem> problems;
    const auto refuse =
        [&](bool wrong, const char *setting, const std::string &entry, const std::string &text)
    {
        if (wrong)
        {
            problems.push_back({setting, entry, text, true});
        }
    };
    refuse(settings.Node.empty() || settings.Node.size() > MaxNodeName, "node", "",
           "the node name must have 1 to 200 bytes, not " + std::to_string(settings.Node.size()));
    refuse(settings.Node.find('\0') != std::string::npos, "node", "", "the node name contains a zero byte");
    refuse(settings.Domain < 0 || settings.Domain > MaxDomain, "domain", "",
           "the domain must be 0 to 232, not " + std::to_string(settings.Domain));
    for (const std::string &interface : settings.Interfaces)
    {
        refuse(!IsInterface(interface), "interfaces", interface,
               "the interface " + interface + " is neither an IPv4 address nor the name of an interface" +
                   (IsIpv6(interface) ? ": nodes use IPv4" : ""));
    }
    for (const std::string &peer : settings.Peers)
    {
        try
        {
            ParsePeer(peer);
        }
        catch (const TransportError &error)
        {
            refuse(true, "peers", peer, error.what());
        }
    }
    refuse(settings.MaxDatagram < TransportSettings::SmallestDatagram ||
               settings.MaxDatagram > TransportSettings::LargestDatagram,
           "max_datagram", "",
           "the largest datagram must be " + std::to_string(TransportSettings::SmallestDatagram) + " to " +
               std::to_string(TransportSettings::LargestDatagram) + " bytes, not " +
               std::to_string(settings.MaxDatagram));
    refuse(settings.AnnouncementPeriod.count() <= 0 || settings.Lease <= settings.AnnouncementPeriod, "lease",
           "", "the lease must be longer than the announcement period, and both positive");
    if (settings.Member != nullptr)
    {
        const std::string &name = settings.Member->Name();
        refuse(name != settings.Node, "security", "",
               "the keys are those of node " + name + ", not of " + settings.Node +
                   ": use the keys of this node");
    }
    return problems;
}

void CheckSettings(const TransportSettings &settings)
{
    if (const auto problems = FindImpossible(settings); !problems.empty())
    {
        throw TransportError(problems.front().Text, problems.front().Setting);
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

}  // namespace Rabit
