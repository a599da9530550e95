#include "DomainConfig.h"

#include <algorithm>
#include <fstream>
#include <locale>
#include <sstream>

#include "common/HostNetworks.h"
#include "common/MulticastUse.h"
#include "common/PeerAddress.h"

namespace Rabit::Cyclone
{

namespace
{

// Limit of sessions on one host and domain; each has its own ports.
constexpr int MostParticipants = 100;
// A peer without a port is looked for at the ports of this many participants of its host, as with Fast DDS.
// The vendor's default would be MostParticipants, each with every announcement.
constexpr int ParticipantsPerPeer = 16;
// Largest size of the vendor's headers in a datagram with a fragment of a sample.
constexpr std::size_t HeaderRoom = 100;
// The vendor's default for the largest datagram of a repair.
constexpr std::size_t LargestRepair = 1456;

// OMG DDSI-RTPS 2.3, 9.6.1.1
int DiscoveryPort(int domain, int participant)
{
    constexpr int Base = 7400;
    constexpr int PerDomain = 250;
    constexpr int Unicast = 10;
    return Base + PerDomain * domain + Unicast + 2 * participant;
}

void AddInterfaces(const TransportSettings &settings, std::ostream &xml)
{
    xml << "<Interfaces>";
    for (const auto &address : settings.Interfaces)
    {
        // Linux does not mark loopback as capable of multicast, although it is.
        const bool isLoopback = address.starts_with("127.");
        xml << "<NetworkInterface address=\"" << address << "\" multicast=\""
            << (!settings.Multicast ? "false"
                : isLoopback        ? "true"
                                    : "default")
            << "\"/>";
    }
    xml << "</Interfaces>";
}

// True if a peer is on none of our networks.
bool IsRoutingNeeded(const TransportSettings &settings)
{
    const auto host = ListHostNetworks().value_or(std::vector<HostNetwork>());
    const auto isHere = [&](const std::string &peer)
    {
        return std::any_of(host.begin(), host.end(),
                           [&](const HostNetwork &network)
                           { return network.Contains(ParsePeer(peer).Host); });
    };
    return !std::all_of(settings.Peers.begin(), settings.Peers.end(), isHere);
}

void AddPeers(const TransportSettings &settings, std::ostream &xml)
{
    xml << "<Peers>";
    for (const auto &peer : settings.Peers)
    {
        const PeerAddress address = ParsePeer(peer);
        const auto ports = address.Port != 0 ? std::vector<std::uint16_t>{address.Port}
                                             : UsualDiscoveryPorts(settings.Domain, ParticipantsPerPeer);
        for (const std::uint16_t port : ports)
        {
            xml << "<Peer address=\"" << address.Host << ":" << port << "\"/>";
        }
    }
    xml << "</Peers>";
}

std::string Read(const std::string &path)
{
    std::ifstream file(path);
    std::ostringstream content;
    content.imbue(std::locale::classic());
    if (!file || !(content << file.rdbuf()))
    {
        throw TransportError("the Cyclone DDS configuration " + path + " cannot be read", "backend_config");
    }
    return content.str();
}

}  // namespace

std::vector<std::uint16_t> UsualDiscoveryPorts(int domain, int count)
{
    std::vector<std::uint16_t> ports;
    for (int i = 0; i < count; ++i)
    {
        ports.push_back(static_cast<std::uint16_t>(DiscoveryPort(domain, i)));
    }
    return ports;
}

bool HasOwnInterfaces(const std::string &configFile)
{
    return !configFile.empty() && Read(configFile).find("<NetworkInterface") != std::string::npos;
}

Rtps::RtpsGuard::Mode GuardMode(const TransportSettings &settings)
{
    using Mode = Rtps::RtpsGuard::Mode;
    const std::string config = settings.BackendConfig.empty() ? "" : Read(settings.BackendConfig);
    return config.find("SharedMemory>") != std::string::npos ? Mode::StructureOnly : Mode::Full;
}

std::string MakeDomainConfig(const TransportSettings &settings, std::size_t added)
{
    const std::size_t largest = settings.MaxDatagram - added;
    std::ostringstream xml;
    xml.imbue(std::locale::classic());  // the program's own may write 1400 as 1,400
    xml << "<Domain><General>";
    if (!HasOwnInterfaces(settings.BackendConfig))
    {
        AddInterfaces(settings, xml);
    }
    xml << "<AllowMulticast>"
        << (IsMulticastForData(settings) ? "true"
            : settings.Multicast         ? "spdp"
                                         : "false")
        << "</AllowMulticast>"
        << "<DontRoute>" << (IsRoutingNeeded(settings) ? "false" : "true") << "</DontRoute>"
        << "<MaxMessageSize>" << largest << "B</MaxMessageSize>"
        << (added > 0 ? "<MaxRexmitMessageSize>" + std::to_string(std::min(largest, LargestRepair)) +
                            "B</MaxRexmitMessageSize>"
                      : std::string())
        << "<FragmentSize>" << largest - HeaderRoom
        << "B</FragmentSize></General>"
        // Between sessions that share a domain, the vendor delivers samples inside Write. So each session has
        // a domain of its own; only on the network it has the configured number.
        << "<Discovery><ExternalDomainId>" << settings.Domain << "</ExternalDomainId>"
        << "<ParticipantIndex>auto</ParticipantIndex>"
        << "<MaxAutoParticipantIndex>" << MostParticipants << "</MaxAutoParticipantIndex>"
        << "<LeaseDuration>" << settings.Lease.count() << "ms</LeaseDuration>"
        << "<SPDPInterval>" << settings.AnnouncementPeriod.count() << "ms</SPDPInterval>";
    AddPeers(settings, xml);
    // Requests for repair go at once: the default delays them, and the end of a replay, by 100 ms and more.
    // Readers that do not acknowledge get heartbeats less and less often. Samples that several readers lack,
    // as at a start, are repaired for all at once. A reader asks a writer by itself only if the writer has
    // not addressed it within 100 ms.
    xml << "</Discovery><Internal><GenerateKeyhash>true</GenerateKeyhash>"
        // Datagrams are lost until they can be opened (VendorDomain::Hear).
        << (added > 0 ? "<ControlTopic><Deaf>true</Deaf></ControlTopic>" : "")
        << "<HeartbeatInterval max=\"4s\" minsched=\"100ms\">100ms</HeartbeatInterval>"
        << "<NackDelay>1ms</NackDelay><PreEmptiveAckDelay>100ms</PreEmptiveAckDelay>"
        << "<RetransmitMerging>always</RetransmitMerging>"
        << "<RetransmitMergingPeriod>20ms</RetransmitMergingPeriod>"
        // The vendor ends further threads by a message to its own address, and waits for ever if the address
        // is gone.
        << "<MultipleReceiveThreads>false</MultipleReceiveThreads>"
        << "<SocketReceiveBufferSize min=\"default\" max=\"4MB\"/>"
        << "<Watermarks><WhcHigh>128MB</WhcHigh></Watermarks></Internal>"
        // The vendor fills a receive buffer from end to end and then takes another, of a megabyte by default.
        << "<Sizing><ReceiveBufferSize>256KiB</ReceiveBufferSize></Sizing></Domain>";
    if (!settings.BackendConfig.empty())
    {
        xml << "," << Read(settings.BackendConfig);
    }
    return xml.str();
}

}  // namespace Rabit::Cyclone
