#include "ParticipantSettings.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <utility>

#include "common/MulticastUse.h"
#include "common/ParticipantIdentity.h"
#include "common/PeerAddress.h"
#include "common/SettingsCheck.h"

namespace Rabit::FastDds
{

using namespace Rtps;

using rtps::SharedMemTransportDescriptor;
using rtps::UDPv4TransportDescriptor;

namespace
{

// The kernel caps them at net.core.rmem_max and wmem_max.
constexpr std::uint32_t SocketBuffer = 4u << 20;
// A peer without a port is looked for at the ports of this many participants of its host.
constexpr std::uint32_t ParticipantsPerPeer = 16;
// A host that is not listed is answered at the ports of this many participants. An answer is small, but goes
// to each of them.
constexpr std::uint32_t ParticipantsPerStranger = 4;
// OMG DDSI-RTPS 2.3, 9.6.1.4.1: the discovery group, and by default the group of samples.
constexpr const char *MulticastAddress = "239.255.0.1";

Duration ToDuration(std::chrono::milliseconds time)
{
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time);
    return {static_cast<std::int32_t>(seconds.count()),
            static_cast<std::uint32_t>(std::chrono::nanoseconds(time - seconds).count())};
}

rtps::RTPSParticipantAttributes ReadProfile(const std::string &file)
{
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    if (!std::filesystem::is_regular_file(file))
    {
        throw TransportError("there is no Fast DDS profiles file " + file, "backend_config");
    }
    auto profile = LoadProfile(file);
    if (!profile)
    {
        throw TransportError("Fast DDS does not accept the profiles file " + file, "backend_config");
    }
    return *profile;
}

// The guard and the cards must read each datagram; with a member, GuardedUdp must see each one.
void CheckProtection(const TransportSettings &settings, const rtps::RTPSParticipantAttributes &attributes)
{
    const auto &properties = attributes.properties.properties();
    const bool hasSecurity =
        std::any_of(properties.begin(), properties.end(),
                    [](const rtps::Property &property) { return property.name().starts_with("dds.sec."); });
    if (hasSecurity)
    {
        throw TransportError(
            "the profiles file " + settings.BackendConfig +
                " configures DDS Security, which nodes do not use: leave it out, and give the "
                "nodes keys (rabit keys)",
            "backend_config");
    }
    if (settings.Member == nullptr)
    {
        return;
    }
    if (settings.SharedMemory)
    {
        throw TransportError("a node with keys shares no memory with others: leave shared_memory out",
                             "shared_memory");
    }
    if (!attributes.userTransports.empty())
    {
        throw TransportError("the profiles file " + settings.BackendConfig +
                                 " has transports, whose datagrams the keys cannot protect: leave them out",
                             "backend_config");
    }
}

std::uint32_t DiscoveryGroupPort(const TransportSettings &settings,
                                 const rtps::RTPSParticipantAttributes &attributes)
{
    return attributes.port.getMulticastPort(static_cast<std::uint32_t>(settings.Domain));
}

RtpsGuard::Mode GuardMode(const TransportSettings &settings)
{
    return settings.SharedMemory ? RtpsGuard::Mode::StructureOnly : RtpsGuard::Mode::Full;
}

// Bounds the memory that invented participants can take.
void LimitPeers(rtps::RTPSParticipantAttributes &attributes)
{
    constexpr std::size_t MostParticipants = 1024;
    constexpr std::size_t MostEndpoints = 4096;  // of each kind, for each participant
    auto &allocation = attributes.allocation;
    allocation.participants.maximum = std::min(allocation.participants.maximum, MostParticipants);
    allocation.readers.maximum = std::min(allocation.readers.maximum, MostEndpoints);
    allocation.writers.maximum = std::min(allocation.writers.maximum, MostEndpoints);
}

rtps::Locator_t SampleGroup(const TransportSettings &settings,
                            const rtps::RTPSParticipantAttributes &attributes)
{
    const rtps::PortParameters &ports = attributes.port;
    rtps::Locator_t group;
    rtps::IPLocator::setIPv4(group, MulticastAddress);
    group.port =
        ports.portBase + ports.domainIDGain * static_cast<std::uint32_t>(settings.Domain) + ports.offsetd2;
    return group;
}

void AddTransports(const TransportSettings &settings, const std::shared_ptr<SessionLog> &log,
                   GuardedUdpDescriptor::Settings guarded, rtps::RTPSParticipantAttributes &attributes)
{
    auto udp = std::make_shared<UDPv4TransportDescriptor>();
    udp->sendBufferSize = SocketBuffer;
    udp->receiveBufferSize = SocketBuffer;
    // A full send buffer loses the datagram, which a reliable writer repairs. Blocking would hold the writing
    // thread for as long as a slow link needs to drain the buffer.
    udp->non_blocking_send = true;
    udp->interfaceWhiteList = settings.Interfaces;
    udp->maxInitialPeersRange = ParticipantsPerPeer;
    attributes.useBuiltinTransports = false;
    guarded.MaxDatagram = static_cast<std::uint32_t>(settings.MaxDatagram);
    if (guarded.Seal != nullptr)
    {
        guarded.MaxDatagram -= static_cast<std::uint32_t>(guarded.Seal->MostAdded());
        guarded.OnLine = [log](const std::string &line) { log->Line(line); };
        for (std::uint32_t id = 0; id < ParticipantsPerStranger; ++id)
        {
            guarded.DiscoveryPorts.push_back(static_cast<std::uint16_t>(
                attributes.port.getUnicastPort(static_cast<std::uint32_t>(settings.Domain), id)));
        }
    }
    guarded.Mode = GuardMode(settings);
    guarded.SampleGroup =
        IsMulticastForData(settings) ? std::optional(SampleGroup(settings, attributes)) : std::nullopt;
    guarded.GroupPort = IsMulticastForData(settings) ? 0 : DiscoveryGroupPort(settings, attributes);
    guarded.SocketsSendAll = !settings.Interfaces.empty();
    guarded.OnSent = [log](bool samples, std::size_t datagrams, std::size_t bytes)
    { samples ? log->SentSamples(datagrams, bytes) : log->SentDiscovery(datagrams, bytes); };
    guarded.OnDropped = [log] { log->MalformedDatagram(); };
    guarded.Meeting = guarded.Mode == RtpsGuard::Mode::Full ? guarded.Meeting : nullptr;
    guarded.HasPeers = !settings.Peers.empty();
    guarded.Networks =
        OwnNetworks(settings.Interfaces, ListHostNetworks().value_or(std::vector<HostNetwork>()));
    guarded.AnnouncementPeriod = settings.AnnouncementPeriod;
    // GuardedUdp requests the first announcements after the very first, at doubling intervals.
    attributes.builtin.discovery_config.initial_announcements.count = 0;
    attributes.userTransports.push_back(std::make_shared<GuardedUdpDescriptor>(udp, std::move(guarded)));
    if (settings.SharedMemory)
    {
        attributes.userTransports.push_back(std::make_shared<SharedMemTransportDescriptor>());
    }
}

// Where both sides have multicast, one datagram carries a sample to all of its readers, and discovery to all
// participants. Where peers are listed multicast may not pass, and each gets its own datagram.
void AddMulticast(const TransportSettings &settings, rtps::RTPSParticipantAttributes &attributes)
{
    attributes.builtin.avoid_builtin_multicast = !IsMulticastForData(settings);
    if (!IsMulticastForData(settings))
    {
        return;
    }
    attributes.defaultMulticastLocatorList.push_back(SampleGroup(settings, attributes));
    // If only one list of locators is given, the vendor makes none of the other kind. Any address: all
    // addresses of the host, at the usual port.
    attributes.defaultUnicastLocatorList.push_back(rtps::Locator_t());
}

void AddPeers(const TransportSettings &settings, rtps::RTPSParticipantAttributes &attributes)
{
    auto &builtin = attributes.builtin;
    if (!settings.Multicast)
    {
        // An own unicast locator, of any address and the well-known port, keeps the vendor from adding the
        // multicast one.
        rtps::Locator_t anyAddress;
        builtin.metatrafficUnicastLocatorList.push_back(anyAddress);
    }
    if (settings.Peers.empty())
    {
        return;
    }
    for (const auto &peer : settings.Peers)
    {
        const PeerAddress address = ParsePeer(peer);
        rtps::Locator_t locator;
        rtps::IPLocator::setIPv4(locator, address.Host);
        locator.port = address.Port;
        builtin.initialPeersList.push_back(locator);
    }
    if (settings.Multicast)
    {
        // A list of peers replaces the default one, which is the multicast group. Its port is given, because
        // without it the vendor would take the group for a host and send to the ports of its participants.
        rtps::Locator_t group;
        rtps::IPLocator::setIPv4(group, MulticastAddress);
        group.port = DiscoveryGroupPort(settings, attributes);
        builtin.initialPeersList.push_back(group);
    }
}

}  // namespace

rtps::RTPSParticipantAttributes MakeParticipantAttributes(const TransportSettings &settings,
                                                          const std::shared_ptr<SessionLog> &log,
                                                          GuardedUdpDescriptor::Settings udp)
{
    CheckSettings(settings);
    rtps::RTPSParticipantAttributes attributes;
    if (!settings.BackendConfig.empty())
    {
        attributes = ReadProfile(settings.BackendConfig);
    }
    CheckProtection(settings, attributes);
    attributes.setName(settings.Node.c_str());
    // Liveliness of single writers is not used: participants have leases, and nodes send beats.
    attributes.builtin.use_WriterLivelinessProtocol = false;
    auto &discovery = attributes.builtin.discovery_config;
    discovery.leaseDuration = ToDuration(settings.Lease);
    discovery.leaseDuration_announcementperiod = ToDuration(settings.AnnouncementPeriod);
    discovery.initial_announcements.count = 5;
    discovery.initial_announcements.period =
        ToDuration(std::min(std::chrono::milliseconds(250), settings.AnnouncementPeriod));
    LimitPeers(attributes);
    AddProperties(attributes.properties);
    const bool hasCard = attributes.userTransports.empty() && GuardMode(settings) == RtpsGuard::Mode::Full;
    const std::string userData = MakeUserData(settings.Incarnation, hasCard);
    attributes.userData.assign(userData.begin(), userData.end());
    if (attributes.userTransports.empty())
    {
        AddTransports(settings, log, std::move(udp), attributes);
    }
    AddMulticast(settings, attributes);
    AddPeers(settings, attributes);
    return attributes;
}

void CheckConfig(const TransportSettings &settings)
{
    CheckProtection(settings, settings.BackendConfig.empty() ? rtps::RTPSParticipantAttributes()
                                                             : ReadProfile(settings.BackendConfig));
}

bool HasOwnTransports(const std::string &profilesFile)
{
    return !profilesFile.empty() && !ReadProfile(profilesFile).userTransports.empty();
}

void SetLibraryDefaults()
{
    static std::once_flag once;
    std::call_once(once, SwitchIntraprocessOff);
}

}  // namespace Rabit::FastDds
