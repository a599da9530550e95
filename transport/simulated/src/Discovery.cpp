// NetworkCore: participants find and lose each other.
#include <algorithm>
#include <utility>

#include "NetworkCore.h"
#include "common/MulticastUse.h"

namespace Rabit::Simulated
{

namespace
{

// Rounds after the first announcement, at doubling intervals, like our real backends for nodes with cards.
constexpr int InitialRounds = 2;
constexpr Time FirstGap = std::chrono::milliseconds(100);

}  // namespace

void NetworkCore::SendDiscovery(const ParticipantState &from, ParticipantId to, const Datagram &content)
{
    Letters letters;
    for (const auto &[id, other] : _participants)
    {
        const bool isFor = to != Nobody ? id == to : id != from.Id;
        if (isFor && other->Settings.Domain == from.Settings.Domain)
        {
            letters.push_back({id, content, _timings.DiscoveryDelay});
        }
    }
    to != Nobody ? SendTogether(from, std::move(letters), false)
                 : SendToGroup(from, std::move(letters), content);
}

// To all participants in the domain, known or not; repeated periodically.
void NetworkCore::Announce(const ParticipantPtr &participant)
{
    SendDiscovery(*participant, Nobody, {});
    const Time period = participant->Settings.AnnouncementPeriod;
    const int before = participant->Announced++;
    Later(before < InitialRounds ? std::min(FirstGap * (1 << before), period) : period,
          {Event::Kind::AnnouncementTimer, participant->Id, 0, 0, {}});
}

void NetworkCore::HearAnnouncement(const ParticipantPtr &me, ParticipantId from)
{
    // A departed participant sent it before its goodbye, which has overtaken it.
    if (!me->Departed.contains(from) && !me->Peers.contains(from))
    {
        me->Cards.Announced(PrefixOf(from), CardTime());
        AwaitCards(*me);
    }
}

Peer &NetworkCore::MeetPeer(const ParticipantPtr &me, ParticipantId from, const ParticipantState &sender)
{
    const auto [entry, isNew] = me->Peers.try_emplace(from);
    Peer &peer = entry->second;
    if (isNew)
    {
        peer.Birth = ++_lastBirth;
        peer.Who = me->Sessions.Add(from, *sender.Who);
        peer.Lease = IsMulticastForData(sender.Settings) ? sender.Settings.Memory : sender.Settings.Lease;
        peer.LastHeard = _now;
        Later(peer.Lease, {Event::Kind::LeaseTimer, me->Id, from, peer.Birth, {}});
        TellPeerEvent(me, peer, PeerEvent::Kind::Appeared);
        EndFormerLives(me, peer);
    }
    return peer;
}

// Ends former sessions once they are silent for so long that two of their announcements are missing.
void NetworkCore::EndFormerLives(const ParticipantPtr &me, const Peer &successor)
{
    const Time silence = 5 * me->Settings.AnnouncementPeriod / 2;
    for (auto &[id, peer] : me->Peers)
    {
        if (peer.Birth != successor.Birth && peer.Who->Node == successor.Who->Node && peer.Lease > silence)
        {
            peer.Lease = silence;
            Later(silence, {Event::Kind::LeaseTimer, me->Id, id, peer.Birth, {}});
        }
    }
}

void NetworkCore::TellPeerEvent(const ParticipantPtr &me, const Peer &peer, PeerEvent::Kind what)
{
    _calls.push_back(
        [me, what, who = peer.Who]
        {
            me->PeerGate.Run(
                [&]
                {
                    if (me->OnPeer)
                    {
                        me->OnPeer({what, who->Node, who->Incarnation});
                    }
                });
        });
}

void NetworkCore::CheckLease(const ParticipantPtr &me, ParticipantId id, std::uint64_t birth)
{
    const auto peer = me->Peers.find(id);
    if (peer == me->Peers.end() || peer->second.Birth != birth)
    {
        return;
    }
    const Time expiry = peer->second.LastHeard + peer->second.Lease;
    if (expiry > _now)
    {
        Later(expiry - _now, {Event::Kind::LeaseTimer, me->Id, id, birth, {}});
        return;
    }
    LosePeer(me, id, PeerEvent::Kind::Lost);
}

void NetworkCore::LosePeer(const ParticipantPtr &me, ParticipantId id, PeerEvent::Kind how)
{
    me->Cards.Forget(PrefixOf(id));
    const auto found = me->Peers.find(id);
    if (found == me->Peers.end())
    {
        return;
    }
    const Peer peer = std::move(found->second);
    me->Peers.erase(found);
    me->Sessions.Remove(id);
    for (const auto &endpoint : *peer.TheirEndpoints)
    {
        EndpointGone(me, endpoint->Id);
    }
    TellPeerEvent(me, peer, how);
}

}  // namespace Rabit::Simulated
