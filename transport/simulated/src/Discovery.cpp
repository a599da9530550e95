// How participants find and lose each other.
#include <algorithm>
#include <utility>

#include "NetworkCore.h"

namespace Rabit::Simulated
{

namespace
{

Datagram MakeAnnouncement(const ParticipantPtr &participant, ParticipantId to)
{
    const auto peer = participant->Peers.find(to);
    Datagram announcement;
    announcement.What = Datagram::Kind::Announce;
    announcement.Sender = participant;
    announcement.First = peer == participant->Peers.end() ? 0 : peer->second.TheirVersion;
    return announcement;
}

}  // namespace

// To everybody in the domain, known or not; and again after a while.
void NetworkCore::Announce(const ParticipantPtr &participant)
{
    Letters letters;
    for (const auto &[id, other] : _participants)
    {
        if (other != participant && other->Settings.Domain == participant->Settings.Domain)
        {
            letters.push_back({id, MakeAnnouncement(participant, id), _timings.DiscoveryDelay});
        }
    }
    SendTogether(*participant, std::move(letters), participant->Settings.Multicast);
    participant->Announcements.OnAnnounced(_now);
    AwaitAnnouncement(*participant);
}

void NetworkCore::AwaitAnnouncement(ParticipantState &participant)
{
    const Time next = std::max(participant.Announcements.Next(), _now);
    Later(next - _now,
          {Event::Kind::AnnouncementTimer, participant.Id, 0, ++participant.AnnouncementTimer, {}});
}

void NetworkCore::HearAnnouncement(const ParticipantPtr &me, ParticipantId from, const Datagram &datagram)
{
    if (me->Departed.contains(from))
    {
        return;  // sent before the goodbye, and overtaken by it
    }
    const auto [entry, isNew] = me->Peers.try_emplace(from);
    Peer &peer = entry->second;
    if (!isNew)
    {
        // One side may have lost the other, and with it what it was told, while the other noticed nothing.
        if (datagram.First < peer.ConfirmedVersion)
        {
            HearEndpointsAck(*me, peer, datagram.First, true);
        }
        if (datagram.First == 0)
        {
            me->Announcements.Owe();
            AwaitAnnouncement(*me);
        }
        return;
    }
    peer.Birth = ++_lastBirth;
    peer.Who = me->Sessions.Add(from, *datagram.Sender->Who);
    peer.Lease = datagram.Sender->Settings.Lease;
    peer.LastHeard = _now;
    Later(peer.Lease, {Event::Kind::LeaseTimer, me->Id, from, peer.Birth, {}});
    TellPeerEvent(me, peer, PeerEvent::Kind::Appeared);
    me->Announcements.Owe();
    AwaitAnnouncement(*me);
    OfferEndpoints(*me);
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
