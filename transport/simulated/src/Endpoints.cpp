// How participants tell each other of their endpoints.
#include <algorithm>
#include <utility>

#include "NetworkCore.h"
#include "common/MulticastUse.h"

namespace Rabit::Simulated
{

namespace
{

Datagram MakeEndpointsAck(std::uint64_t version)
{
    Datagram ack;
    ack.What = Datagram::Kind::EndpointsAck;
    ack.First = version;
    return ack;
}

}  // namespace

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
    Letters letters;
    for (auto &[id, peer] : me.Peers)
    {
        letters.push_back({id, MakeEndpoints(me, id, peer)});
    }
    SendTogether(me, std::move(letters), IsMulticastForData(me.Settings));
}

void NetworkCore::SendEndpoints(const ParticipantState &me, ParticipantId to, Peer &peer)
{
    if (peer.ConfirmedVersion != me.Version)
    {
        Send(me, to, MakeEndpoints(me, to, peer));
    }
}

// They are sent at once, and again until the peer confirms them.
Datagram NetworkCore::MakeEndpoints(const ParticipantState &me, ParticipantId to, Peer &peer)
{
    Datagram datagram;
    datagram.What = Datagram::Kind::Endpoints;
    datagram.First = me.Version;
    datagram.Endpoints = me.Endpoints;
    const auto isNews = [&](const EndpointInfoPtr &endpoint)
    { return endpoint->Since > peer.ConfirmedVersion; };
    datagram.News =
        static_cast<std::size_t>(std::count_if(me.Endpoints->begin(), me.Endpoints->end(), isNews));
    if (!peer.RepairPending)
    {
        peer.RepairPending = true;
        Later(_timings.DiscoveryRepair, {Event::Kind::EndpointRepairTimer, me.Id, to, peer.Birth, {}});
    }
    return datagram;
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
                                                               partitions,
                                                               participant->Version + 1});
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
                                                    partitions,
                                                    participant->Version + 1});
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
