// How participants find and lose each other, and how their endpoints match.
#include <algorithm>
#include <utility>

#include "NetworkCore.h"
#include "PartitionMatch.h"

namespace Rabit::Simulated
{

namespace
{

constexpr Time EarlyAnnouncementPeriod = std::chrono::milliseconds(100);

bool IsReliable(const EndpointInfo &endpoint)
{
    return endpoint.Qos.Reliability == Reliability::Reliable;
}

bool IsTransientLocal(const EndpointInfo &endpoint)
{
    return endpoint.Qos.Durability == Durability::TransientLocal;
}

Datagram MakeEndpointsAck(std::uint64_t version)
{
    Datagram ack;
    ack.What = Datagram::Kind::EndpointsAck;
    ack.First = version;
    return ack;
}

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
    for (const auto &[id, other] : _participants)
    {
        if (other != participant && other->Settings.Domain == participant->Settings.Domain)
        {
            Send(*participant, id, MakeAnnouncement(participant, id), _timings.DiscoveryDelay);
        }
    }
    Time next = participant->Settings.AnnouncementPeriod;
    if (participant->EarlyAnnouncements > 0)
    {
        --participant->EarlyAnnouncements;
        next = std::min(next, EarlyAnnouncementPeriod);
    }
    Later(next, {Event::Kind::AnnouncementTimer, participant->Id, 0, 0, {}});
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
        HearEndpointsAck(*me, from, peer, datagram.First);
        return;
    }
    peer.Birth = ++_lastBirth;
    peer.Who = datagram.Sender->Who;
    peer.Lease = datagram.Sender->Settings.Lease;
    peer.LastHeard = _now;
    Later(peer.Lease, {Event::Kind::LeaseTimer, me->Id, from, peer.Birth, {}});
    TellPeerEvent(me, peer, PeerEvent::Kind::Appeared);
    Send(*me, from, MakeAnnouncement(me, from), _timings.DiscoveryDelay);
    SendEndpoints(*me, from, peer);
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
    for (const auto &endpoint : *peer.TheirEndpoints)
    {
        EndpointGone(me, endpoint->Id);
    }
    TellPeerEvent(me, peer, how);
}

void NetworkCore::EndpointsChanged(ParticipantState &me, EndpointInfoPtr added, const EndpointId &removed)
{
    auto endpoints = std::make_shared<EndpointList>(*me.Endpoints);
    if (added != nullptr)
    {
        endpoints->push_back(std::move(added));
    }
    std::erase_if(*endpoints, [&](const EndpointInfoPtr &endpoint) { return endpoint->Id == removed; });
    me.Endpoints = std::move(endpoints);
    ++me.Version;
    for (auto &[id, peer] : me.Peers)
    {
        SendEndpoints(me, id, peer);
    }
}

void NetworkCore::SendEndpoints(const ParticipantState &me, ParticipantId to, Peer &peer)
{
    if (peer.ConfirmedVersion == me.Version)
    {
        return;
    }
    Datagram datagram;
    datagram.What = Datagram::Kind::Endpoints;
    datagram.First = me.Version;
    datagram.Endpoints = me.Endpoints;
    Send(me, to, std::move(datagram));
    if (!peer.RepairPending)
    {
        peer.RepairPending = true;
        Later(_timings.DiscoveryRepair, {Event::Kind::EndpointRepairTimer, me.Id, to, peer.Birth, {}});
    }
}

void NetworkCore::RepairEndpoints(ParticipantState &me, ParticipantId to, std::uint64_t birth)
{
    const auto peer = me.Peers.find(to);
    if (peer != me.Peers.end() && peer->second.Birth == birth)
    {
        peer->second.RepairPending = false;
        SendEndpoints(me, to, peer->second);
    }
}

void NetworkCore::HearEndpointsAck(const ParticipantState &me, ParticipantId from, Peer &peer,
                                   std::uint64_t version)
{
    peer.ConfirmedVersion = version;
    SendEndpoints(me, from, peer);
}

void NetworkCore::HearEndpoints(const ParticipantPtr &me, ParticipantId from, const Datagram &datagram)
{
    const auto known = me->Peers.find(from);
    if (known == me->Peers.end())
    {
        return;  // it says so again until this participant has discovered it and confirms
    }
    Peer &peer = known->second;
    if (datagram.First > peer.TheirVersion)
    {
        const auto before = std::exchange(peer.TheirEndpoints, datagram.Endpoints);
        peer.TheirVersion = datagram.First;
        const auto byId = [](const EndpointInfoPtr &a, const EndpointInfoPtr &b) { return a->Id < b->Id; };
        EndpointList gone;
        std::set_difference(before->begin(), before->end(), peer.TheirEndpoints->begin(),
                            peer.TheirEndpoints->end(), std::back_inserter(gone), byId);
        EndpointList added;
        std::set_difference(peer.TheirEndpoints->begin(), peer.TheirEndpoints->end(), before->begin(),
                            before->end(), std::back_inserter(added), byId);
        for (const auto &endpoint : gone)
        {
            EndpointGone(me, endpoint->Id);
        }
        for (const auto &endpoint : added)
        {
            EndpointAppeared(me, peer, *endpoint);
        }
    }
    Send(*me, from, MakeEndpointsAck(peer.TheirVersion));
}

void NetworkCore::EndpointAppeared(const ParticipantPtr &me, const Peer &peer, const EndpointInfo &remote)
{
    _calls.push_back([me, id = ToWriterId(remote.Id), topic = remote.Topic, type = remote.Type,
                      node = peer.Who->Node] { me->Topics.RemoteAppeared(id, topic, type, node); });
    if (remote.IsWriter)
    {
        for (const auto &[id, reader] : me->Readers)
        {
            MatchWriter(me, peer, *reader, remote);
        }
        return;
    }
    for (const auto &[id, writer] : me->Writers)
    {
        MatchReader(me, *writer, remote);
    }
}

void NetworkCore::EndpointGone(const ParticipantPtr &me, const EndpointId &remote)
{
    _calls.push_back([me, id = ToWriterId(remote)] { me->Topics.RemoteGone(id); });
    for (const auto &[id, writer] : me->Writers)
    {
        writer->Readers.erase(remote);
    }
    for (const auto &[id, reader] : me->Readers)
    {
        const auto proxy = reader->Writers.find(remote);
        if (proxy != reader->Writers.end())
        {
            UnmatchWriter(reader, proxy);
        }
    }
}

bool NetworkCore::Fits(const ParticipantPtr &me, const EndpointInfo &writer, const EndpointInfo &reader)
{
    if (writer.Topic != reader.Topic || writer.Type != reader.Type || writer.Keyed != reader.Keyed ||
        !PartitionsMatch(writer.Partitions, reader.Partitions))
    {
        return false;
    }
    if ((IsReliable(reader) && !IsReliable(writer)) ||
        (IsTransientLocal(reader) && !IsTransientLocal(writer)))
    {
        _calls.push_back([me, topic = writer.Topic] { me->Log->IncompatibleQos(topic); });
        return false;
    }
    return true;
}

void NetworkCore::MatchReader(const ParticipantPtr &me, WriterState &writer, const EndpointInfo &remote)
{
    if (!Fits(me, *writer.Info, remote))
    {
        return;
    }
    const auto [proxy, isNew] = writer.Readers.try_emplace(remote.Id);
    if (!isNew)
    {
        return;
    }
    proxy->second.Reliable = IsReliable(remote);
    proxy->second.Acknowledged = writer.LastSequence;
    if (IsReliable(remote) && IsTransientLocal(remote))
    {
        proxy->second.Acknowledged = 0;
        for (const auto &sample : writer.History)
        {
            CountSample(*me, *sample, 1);
            SendSample(*me, writer, remote.Id, proxy->second, sample);
        }
        KeepHeartbeat(writer);
    }
}

void NetworkCore::MatchWriter(const ParticipantPtr &me, const Peer &peer, ReaderState &reader,
                              const EndpointInfo &remote)
{
    if (Fits(me, remote, *reader.Info))
    {
        const auto [proxy, isNew] = reader.Writers.try_emplace(remote.Id);
        if (isNew)
        {
            proxy->second.Node = peer.Who;
            proxy->second.Reliable = IsReliable(*reader.Info);
        }
    }
}

void NetworkCore::UnmatchWriter(const ReaderPtr &reader, std::map<EndpointId, WriterProxy>::iterator proxy)
{
    if (reader->Info->Keyed)
    {
        _calls.push_back(
            [reader, id = ToWriterId(proxy->first), node = proxy->second.Node]
            {
                reader->Gate.Run(
                    [&]
                    {
                        for (const KeyHash &key : reader->Instances.WriterGone(id))
                        {
                            SampleInfo info;
                            info.Writer = id;
                            info.Node = node->Node;
                            info.Incarnation = node->Incarnation;
                            info.Alive = false;
                            info.Key = key;
                            reader->Handler({}, info);
                        }
                    });
            });
    }
    reader->Writers.erase(proxy);
}

WriterPtr NetworkCore::AddWriter(const ParticipantPtr &participant, const TopicDescription &topic,
                                 const TopicQos &qos, const std::vector<std::string> &partitions)
{
    std::unique_lock lock(_mutex);
    const auto writer = std::make_shared<WriterState>();
    writer->Info = std::make_shared<EndpointInfo>(EndpointInfo{{participant->Id, ++participant->LastEntity},
                                                               true,
                                                               topic.Name,
                                                               topic.TypeName,
                                                               static_cast<bool>(topic.KeyOf),
                                                               qos,
                                                               partitions});
    participant->Writers.emplace(writer->Info->Id, writer);
    for (const auto &[id, peer] : participant->Peers)
    {
        for (const auto &remote : *peer.TheirEndpoints)
        {
            if (!remote->IsWriter)
            {
                MatchReader(participant, *writer, *remote);
            }
        }
    }
    EndpointsChanged(*participant, writer->Info, {});
    RunCalls(lock);
    return writer;
}

ReaderPtr NetworkCore::AddReader(const ParticipantPtr &participant, const TopicDescription &topic,
                                 const TopicQos &qos, const std::vector<std::string> &partitions,
                                 SampleHandler handler)
{
    std::unique_lock lock(_mutex);
    const auto info =
        std::make_shared<EndpointInfo>(EndpointInfo{{participant->Id, ++participant->LastEntity},
                                                    false,
                                                    topic.Name,
                                                    topic.TypeName,
                                                    static_cast<bool>(topic.KeyOf),
                                                    qos,
                                                    partitions});
    const auto reader = std::make_shared<ReaderState>(participant->Log, info, std::move(handler));
    participant->Readers.emplace(info->Id, reader);
    for (const auto &[id, peer] : participant->Peers)
    {
        for (const auto &remote : *peer.TheirEndpoints)
        {
            if (remote->IsWriter)
            {
                MatchWriter(participant, peer, *reader, *remote);
            }
        }
    }
    EndpointsChanged(*participant, info, {});
    RunCalls(lock);
    return reader;
}

void NetworkCore::RemoveWriter(ParticipantState &participant, const WriterState &writer)
{
    const std::lock_guard lock(_mutex);
    participant.Writers.erase(writer.Info->Id);
    EndpointsChanged(participant, nullptr, writer.Info->Id);
}

void NetworkCore::RemoveReader(ParticipantState &participant, const ReaderState &reader)
{
    const std::lock_guard lock(_mutex);
    participant.Readers.erase(reader.Info->Id);
    EndpointsChanged(participant, nullptr, reader.Info->Id);
}

}  // namespace Rabit::Simulated
