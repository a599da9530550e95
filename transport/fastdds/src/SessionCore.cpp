#include "SessionCore.h"

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <random>
#include <string>
#include <system_error>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "EndpointSettings.h"
#include "ParticipantSettings.h"
#include "common/MulticastUse.h"

namespace Rabit::FastDds
{

namespace
{

Rtps::GuidPrefix NameOf(const rtps::GuidPrefix_t &prefix)
{
    Rtps::GuidPrefix name{};
    std::copy_n(prefix.value, name.size(), name.begin());
    return name;
}

// A prefix that no other participant has or had; the vendor would derive it from the number. Begins as the
// vendor's do (OMG DDSI-RTPS 2.3, 9.3.1.5).
rtps::GuidPrefix_t MakeGuidPrefix()
{
    std::random_device random;
    std::uniform_int_distribution<int> byte(0, 255);
    rtps::GuidPrefix_t prefix;
    std::generate(std::begin(prefix.value), std::end(prefix.value),
                  [&] { return static_cast<rtps::octet>(byte(random)); });
    std::copy(rtps::c_VendorId_eProsima.begin(), rtps::c_VendorId_eProsima.end(), std::begin(prefix.value));
    return prefix;
}

// The header of the datagrams of a participant of the vendor's, of RTPS 2.3 (OMG DDSI-RTPS 2.3, 8.3.3.1).
Envelope::RtpsHeader HeaderOf(const rtps::GuidPrefix_t &prefix)
{
    Envelope::RtpsHeader header{
        'R', 'T', 'P', 'S', 2, 3, rtps::c_VendorId_eProsima[0], rtps::c_VendorId_eProsima[1]};
    std::copy(std::begin(prefix.value), std::end(prefix.value), header.begin() + Rtps::PrefixAt);
    return header;
}

PeerPlace PlaceOf(const ParticipantNews &peer)
{
    PeerPlace place;
    for (const auto *locators : {&peer.Discovery.unicast, &peer.Samples.unicast})
    {
        for (const rtps::Locator_t &locator : *locators)
        {
            if (locator.kind == LOCATOR_KIND_UDPv4)
            {
                place.push_back(rtps::IPLocator::toIPv4string(locator));
            }
        }
    }
    return place;
}

// Why datagrams to groups cannot be received at that port, as far as an attempt to listen there tells.
std::string WhyDeaf(int domain, std::uint32_t port)
{
    std::string why;
    if (const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0); socket >= 0)
    {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        if (::bind(socket, reinterpret_cast<const sockaddr *>(&address), sizeof address) != 0)
        {
            why = errno == EADDRINUSE ? ": another program has it"
                                      : ": " + std::generic_category().message(errno);
        }
        ::close(socket);
    }
    return "Fast DDS cannot join domain " + std::to_string(domain) + ": it cannot listen at UDP port " +
           std::to_string(port) + ", by which nodes find each other" + why +
           "; end the program that has it (ss -ulpn), or choose another domain";
}

RemoteEndpoint Described(const EndpointNews &news, const std::string &node)
{
    return {.Id = ToWriterId(news.Guid),
            .IsWriter = news.IsWriter,
            .Topic = news.Topic,
            .Type = news.Type,
            .Reliability = news.Reliability == dds::RELIABLE_RELIABILITY_QOS ? Reliability::Reliable
                                                                             : Reliability::BestEffort,
            .Durability = news.Durability == dds::VOLATILE_DURABILITY_QOS ? Durability::Volatile
                                                                          : Durability::TransientLocal,
            .Partitions = news.Partitions,
            .Node = node,
            .HasDeadline = news.HasDeadline,
            .HasLiveliness = news.HasLiveliness,
            .IsExclusive = news.IsExclusive};
}

}  // namespace

SessionCore::SessionCore(const TransportSettings &settings, const SessionContext &context)
    : VendorCore(settings, context),
      _announceGate(Log(), "announcements"),
      _multicast(IsMulticastForData(settings)),
      _meeting(std::make_shared<Rtps::MeetingThread>(
          Rtps::Meeting::Settings{.Period = settings.AnnouncementPeriod,
                                  .Memory = _multicast ? settings.Memory : settings.Lease,
                                  .IsMulticast = _multicast},
          context.Turns)),
      _seal(settings.Member ? std::make_shared<Envelope::SealedSession>(settings.Member, context.Turns)
                            : nullptr)
{
    const rtps::GuidPrefix_t prefix = MakeGuidPrefix();
    auto attributes = MakeParticipantAttributes(settings, Log(),
                                                {.OnDeaf = [this](auto port) { _deafAt = port; },
                                                 .Sending = context.Sending,
                                                 .Announce = [this] { Announce(); },
                                                 .AnnounceAt = [this](auto time) { _announceTimer.At(time); },
                                                 .Seal = _seal,
                                                 .Header = HeaderOf(prefix),
                                                 .Meeting = _meeting,
                                                 .Goodbyes = _goodbyes,
                                                 .Accounts = _accounts});
    attributes.participantID = static_cast<std::int32_t>(_number.Get());
    attributes.prefix = prefix;
    SetLibraryDefaults();
    ReadInterfaces();
    // Before the vendor has the participant: it would go on calling a session whose start has failed.
    _announceTimer.Start([this] { Announce(); });
    // Disabled at first, so that nothing is discovered before _participant is known here.
    _participant = rtps::RTPSDomain::createParticipant(static_cast<std::uint32_t>(settings.Domain), false,
                                                       attributes, this);
    if (_participant == nullptr)
    {
        throw TransportError("Fast DDS cannot join domain " + std::to_string(settings.Domain) +
                             ": no free port, or no usable network interface");
    }
    if (_seal != nullptr && !_seal->IsStarted())
    {
        Leave();
        throw TransportError("Fast DDS cannot seal datagrams with the keys of " + settings.Node, "security");
    }
    _participant.load()->enable();
    if (const std::uint32_t port = _deafAt; port != 0)
    {
        Leave();
        throw TransportError(WhyDeaf(settings.Domain, port), "domain");
    }
}

SessionCore::~SessionCore()
{
    Leave();
}

void SessionCore::Leave()
{
    Close();
    _meeting->Stop();
    if (_seal != nullptr)
    {
        _seal->Stop();
    }
    _announceTimer.Stop();
    RemoveOwnSamples(*_participant);
    rtps::RTPSDomain::removeRTPSParticipant(_participant);
}

void SessionCore::Close()
{
    VendorCore::Close();
    _announceGate.Close();
}

bool SessionCore::IsOwn(const GuidPrefix &prefix) const
{
    return prefix == _participant.load()->getGuid().guidPrefix;
}

void SessionCore::OnParticipant(const ParticipantNews &news)
{
    switch (news.Change)
    {
        case ParticipantChange::Present:
            PeerAppeared(news);
            break;
        case ParticipantChange::Left:
            PeerGone(NameOf(news.Prefix), PeerEvent::Kind::Left);
            break;
        case ParticipantChange::Lost:
            PeerGone(NameOf(news.Prefix), PeerEvent::Kind::Lost);
            break;
    }
}

void SessionCore::Announce()
{
    _announceGate.Run(
        [this]
        {
            if (rtps::RTPSParticipant *const participant = _participant; participant != nullptr)
            {
                participant->announceRTPSParticipantState();
            }
        });
}

void SessionCore::PeerAppeared(const ParticipantNews &peer)
{
    const auto incarnation = ParseUserData(peer.UserData);
    if (incarnation && !IsOwn(peer.Prefix))
    {
        Appeared(NameOf(peer.Prefix), {peer.Name, *incarnation}, PlaceOf(peer));
    }
}

void SessionCore::PeerGone(const Rtps::GuidPrefix &peer, PeerEvent::Kind how)
{
    if (how == PeerEvent::Kind::Lost)
    {
        _accounts->Left(peer);
        _meeting->Lost(peer);
    }
    else if (_meeting->WasEnded(peer))
    {
        how = PeerEvent::Kind::Lost;
    }
    Gone(peer, how);
}

// The vendor also reports our own endpoints.
void SessionCore::OnEndpoint(const EndpointNews &news)
{
    const WriterId id = ToWriterId(news.Guid);
    if (news.IsRemoved)
    {
        Topics().RemoteGone(id);
    }
    else if (!IsOwn(news.Guid.guidPrefix))
    {
        const auto identity = IdentityOf(id);
        Topics().RemoteAppeared(Described(news, identity != nullptr ? identity->Node : ""));
    }
}

}  // namespace Rabit::FastDds
