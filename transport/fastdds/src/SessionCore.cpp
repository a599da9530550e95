#include "SessionCore.h"

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>
#include <fastdds/rtps/builtin/data/ReaderProxyData.h>
#include <fastdds/rtps/builtin/data/WriterProxyData.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <chrono>
#include <type_traits>
#include <utility>

#include "EndpointSettings.h"
#include "KeyAddressees.h"
#include "ParticipantSettings.h"
#include "common/MulticastUse.h"

namespace Rabit::FastDds
{

namespace rtps = eprosima::fastrtps::rtps;

namespace
{

// OMG DDS Security 1.1, 9.4.2.4: what a participant announces of its protection.
constexpr std::uint32_t IsSecured = 1u << 31;
constexpr std::uint32_t HasDiscoveryEncrypted = 1u << 1;

// The prefix with which an identity begins.
template <typename Bytes>
rtps::GuidPrefix_t ToVendorPrefix(const Bytes &bytes)
{
    rtps::GuidPrefix_t result;
    std::copy_n(bytes.begin(), rtps::GuidPrefix_t::size, result.value);
    return result;
}

Rtps::GuidPrefix NameOf(const rtps::GuidPrefix_t &prefix)
{
    Rtps::GuidPrefix name{};
    std::copy_n(prefix.value, name.size(), name.begin());
    return name;
}

PeerPlace PlaceOf(const rtps::ParticipantProxyData &peer)
{
    PeerPlace place;
    for (const auto *locators : {&peer.metatraffic_locators.unicast, &peer.default_locators.unicast})
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

// A writer's or a reader's announcement.
template <typename Proxy>
RemoteEndpoint Described(const Proxy &proxy, const std::string &node)
{
    RemoteEndpoint endpoint;
    endpoint.Id = ToWriterId(proxy.guid());
    endpoint.IsWriter = std::is_same_v<Proxy, rtps::WriterProxyData>;
    endpoint.Topic = proxy.topicName().to_string();
    endpoint.Type = proxy.typeName().to_string();
    const auto &qos = proxy.m_qos;
    endpoint.Reliability = qos.m_reliability.kind == eprosima::fastdds::dds::RELIABLE_RELIABILITY_QOS
                               ? Reliability::Reliable
                               : Reliability::BestEffort;
    endpoint.Durability = qos.m_durability.kind == eprosima::fastdds::dds::VOLATILE_DURABILITY_QOS
                              ? Durability::Volatile
                              : Durability::TransientLocal;
    endpoint.Partitions = qos.m_partition.getNames();
    endpoint.Node = node;
    return endpoint;
}

}  // namespace

SessionCore::SessionCore(const TransportSettings &settings, PeerHandler onPeer,
                         std::shared_ptr<DiscoveryTurns> turns)
    : _log(std::make_shared<SessionLog>(settings)),
      _topics(_log),
      _peerGate(_log, "peer events"),
      _announceGate(_log, "announcements"),
      _onPeer(std::move(onPeer)),
      _multicast(IsMulticastForData(settings)),
      _proof(settings, _log),
      _meeting(std::make_shared<Rtps::MeetingThread>(
          Rtps::Meeting::Settings{.Period = settings.AnnouncementPeriod,
                                  .Memory = _multicast ? settings.Memory : settings.Lease,
                                  .IsMulticast = _multicast},
          turns))
{
    auto attributes = MakeParticipantAttributes(
        settings, _log,
        {.Announce = [this] { Announce(); },
         .AnnounceAt = [this](auto time) { _announceTimer.At(time); },
         .IsInGroup = [this](const auto &prefix) { return IsInGroup(ToVendorPrefix(prefix)); },
         .SendOwedAt = [this](auto time) { _owedTimer.At(time); },
         .Owed = _owed,
         .Turns = std::move(turns),
         .Meeting = _meeting,
         .Authentication = _authentication,
         .Goodbyes = _goodbyes});
    attributes.participantID = _number.Get();
    attributes.prefix = MakeGuidPrefix();
    SetLibraryDefaults();
    // Disabled at first, so that nothing is discovered before _participant is known here.
    _participant = rtps::RTPSDomain::createParticipant(static_cast<std::uint32_t>(settings.Domain), false,
                                                       attributes, this);
    if (_participant == nullptr)
    {
        throw TransportError("Fast DDS cannot join domain " + std::to_string(settings.Domain) +
                             ": no free port, or no usable network interface" +
                             (settings.Security ? ", or it does not accept the keys" : ""));
    }
    _announceTimer.Start(*_participant, [this] { Announce(); });
    _owedTimer.Start(*_participant, [owed = _owed] { owed->Run(); });
    _participant.load()->enable();
    if (settings.Security && !KeyAddressees::Heed(*_participant))
    {
        _log->Line("Fast DDS does not show its writer of keys: it says them to all");
    }
}

SessionCore::~SessionCore()
{
    Close();
    _meeting->Stop();
    _authentication->Stop();
    _announceTimer.Stop();
    _owedTimer.Stop();
    rtps::RTPSDomain::removeRTPSParticipant(_participant);
}

void SessionCore::Close()
{
    _closed = true;
    _announceGate.Close();
    _peerGate.Close();
}

bool SessionCore::IsOwn(const GuidPrefix &prefix) const
{
    return prefix == _participant.load()->getGuid().guidPrefix;
}

std::shared_ptr<const PeerSession> SessionCore::IdentityOf(const WriterId &endpoint) const
{
    const GuidPrefix prefix = ToVendorPrefix(endpoint);
    const std::lock_guard lock(_mutex);
    return _peers.Find(prefix);
}

std::set<SessionCore::GuidPrefix> SessionCore::PrefixesOf(const std::string &node) const
{
    const std::lock_guard lock(_mutex);
    const std::vector<GuidPrefix> prefixes = _peers.Of(node);
    return {prefixes.begin(), prefixes.end()};
}

std::vector<PeerPlace> SessionCore::PeerPlaces() const
{
    const std::lock_guard lock(_mutex);
    std::vector<PeerPlace> places;
    for (const auto &[prefix, place] : _places)
    {
        places.push_back(place);
    }
    return places;
}

void SessionCore::onParticipantDiscovery(rtps::RTPSParticipant * /*participant*/,
                                         rtps::ParticipantDiscoveryInfo &&info)
{
    NotePlace(info);
    switch (info.status)
    {
        case rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT:
        case rtps::ParticipantDiscoveryInfo::CHANGED_QOS_PARTICIPANT:
            PeerAppeared(info.info);
            break;
        case rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT:
            PeerGone(info.info.m_guid.guidPrefix, PeerEvent::Kind::Left);
            break;
        case rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT:
            PeerGone(info.info.m_guid.guidPrefix, PeerEvent::Kind::Lost);
            break;
    }
}

void SessionCore::NotePlace(const rtps::ParticipantDiscoveryInfo &info)
{
    const GuidPrefix &prefix = info.info.m_guid.guidPrefix;
    const bool isGone = info.status == rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT ||
                        info.status == rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT;
    const std::lock_guard lock(_mutex);
    if (_multicast && !isGone && !info.info.metatraffic_locators.multicast.empty())
    {
        _inGroup.insert(prefix);
    }
    else
    {
        _inGroup.erase(prefix);
    }
}

bool SessionCore::IsInGroup(const GuidPrefix &prefix) const
{
    const std::lock_guard lock(_mutex);
    return _inGroup.contains(prefix);
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

void SessionCore::PeerAppeared(const rtps::ParticipantProxyData &peer)
{
    const auto incarnation = ParseUserData(peer.m_userData.data_vec());
    if (!incarnation || IsOwn(peer.m_guid.guidPrefix))
    {
        return;
    }
    const GuidPrefix &prefix = peer.m_guid.guidPrefix;
    const Newcomer newcomer{.Who = std::make_shared<const ParticipantIdentity>(
                                ParticipantIdentity{peer.m_participantName.to_string(), *incarnation}),
                            .Place = PlaceOf(peer)};
    if (_proof.IsWanted())
    {
        if ((peer.plugin_security_attributes_ & IsSecured) != 0)
        {
            _proof.Compare(newcomer.Who->Node,
                           (peer.plugin_security_attributes_ & HasDiscoveryEncrypted) != 0);
        }
        // Authentication confirms the first announcement: later ones may be forged.
        const std::lock_guard lock(_mutex);
        if (!_proven.contains(prefix))
        {
            _unproven.emplace(prefix, newcomer);
            return;
        }
    }
    Admit(prefix, newcomer);
}

void SessionCore::onParticipantAuthentication(rtps::RTPSParticipant * /*participant*/,
                                              rtps::ParticipantAuthenticationInfo &&info)
{
    const GuidPrefix &prefix = info.guid.guidPrefix;
    if (info.status != rtps::ParticipantAuthenticationInfo::AUTHORIZED_PARTICIPANT)
    {
        const std::lock_guard lock(_mutex);
        _proof.Refused(NameOfNewcomer(prefix));
        return;
    }
    Newcomer newcomer;
    {
        const std::lock_guard lock(_mutex);
        _proven.insert(prefix);
        const auto found = _unproven.find(prefix);
        if (found == _unproven.end())
        {
            return;
        }
        newcomer = std::move(found->second);
        _unproven.erase(found);
    }
    Admit(prefix, newcomer);
}

std::string SessionCore::NameOfNewcomer(const GuidPrefix &prefix) const
{
    const auto found = _unproven.find(prefix);
    return found == _unproven.end() ? "" : found->second.Who->Node;
}

void SessionCore::Admit(const GuidPrefix &prefix, const Newcomer &newcomer)
{
    const std::shared_ptr<const ParticipantIdentity> &identity = newcomer.Who;
    if (!_proof.MayBe(identity->Node, std::span<const std::uint8_t, GuidPrefix::size>(prefix.value)))
    {
        return;
    }
    {
        const std::lock_guard lock(_mutex);
        if (_goodbyes->Has(NameOf(prefix), std::chrono::steady_clock::now()) ||
            _peers.Add(prefix, *identity) == nullptr)
        {
            return;
        }
        _places.emplace(prefix, newcomer.Place);
    }
    _peerGate.Run(
        [&]
        {
            if (_onPeer)
            {
                _onPeer({PeerEvent::Kind::Appeared, identity->Node, identity->Incarnation});
            }
        });
}

void SessionCore::PeerGone(const GuidPrefix &prefix, PeerEvent::Kind how)
{
    const Rtps::GuidPrefix name = NameOf(prefix);
    if (how == PeerEvent::Kind::Lost)
    {
        _meeting->Lost(name);
    }
    else if (_meeting->WasEnded(name) || _authentication->WasForgotten(name))
    {
        how = PeerEvent::Kind::Lost;
    }
    _authentication->Gone(name);
    std::shared_ptr<const PeerSession> session;
    {
        const std::lock_guard lock(_mutex);
        if (_authentication->WasForgotten(name))
        {
            _proof.Unfinished(NameOfNewcomer(prefix));
        }
        _unproven.erase(prefix);
        _proven.erase(prefix);
        session = _peers.Remove(prefix);
        if (session == nullptr)
        {
            return;
        }
        _places.erase(prefix);
    }
    _peerGate.Run(
        [&]
        {
            if (_onPeer)
            {
                _onPeer({how, session->Node, session->Incarnation});
            }
        });
}

void SessionCore::onReaderDiscovery(rtps::RTPSParticipant * /*participant*/, rtps::ReaderDiscoveryInfo &&info)
{
    NoteEndpoint(info.info, info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER);
}

void SessionCore::onWriterDiscovery(rtps::RTPSParticipant * /*participant*/, rtps::WriterDiscoveryInfo &&info)
{
    NoteEndpoint(info.info, info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER);
}

// The vendor also reports our own endpoints.
template <typename Proxy>
void SessionCore::NoteEndpoint(const Proxy &endpoint, bool isRemoved)
{
    const WriterId id = ToWriterId(endpoint.guid());
    if (isRemoved)
    {
        _topics.RemoteGone(id);
    }
    else if (!IsOwn(endpoint.guid().guidPrefix))
    {
        const auto identity = IdentityOf(id);
        _topics.RemoteAppeared(Described(endpoint, identity != nullptr ? identity->Node : ""));
    }
}

}  // namespace Rabit::FastDds
