// How participants tell each other of their endpoints.
#include <algorithm>
#include <utility>

#include "NetworkCore.h"
#include "common/MulticastUse.h"

namespace Rabit::Simulated
{

void NetworkCore::EndpointsChanged(ParticipantState &me, EndpointInfoPtr added, const EndpointId &removed)
{
    if (me.Gone)
    {
        return;  // it crashed: its objects are destroyed later, and nobody hears of it
    }
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

// Somebody lacks endpoints.
void NetworkCore::OfferEndpoints(ParticipantState &me)
{
    if (me.EndpointRoundOwed)
    {
        return;
    }
    if (!me.EndpointRoundAt || _now >= *me.EndpointRoundAt + me.EndpointRoundGap)
    {
        SendEndpoints(me);
        return;
    }
    me.EndpointRoundOwed = true;
    Later(*me.EndpointRoundAt + me.EndpointRoundGap - _now,
          {Event::Kind::EndpointRoundTimer, me.Id, 0, 0, {}});
}

// A round, to all who lack some.
void NetworkCore::SendEndpoints(ParticipantState &me)
{
    const bool isRested =
        !me.EndpointRoundAt || _now >= *me.EndpointRoundAt + 4 * _timings.LongestEndpointRound;
    me.EndpointRoundGap =
        isRested ? _timings.EndpointRound : std::min(2 * me.EndpointRoundGap, _timings.LongestEndpointRound);
    me.EndpointRoundAt = _now;
    me.EndpointRoundOwed = false;
    Letters letters;
    for (auto &[id, peer] : me.Peers)
    {
        if (peer.SentVersion != me.Version)
        {
            letters.push_back({id, MakeEndpoints(me, id, peer)});
        }
    }
    SendTogether(me, std::move(letters), IsMulticastForData(me.Settings));
}

// What the peer has not been sent yet.
Datagram NetworkCore::MakeEndpoints(const ParticipantState &me, ParticipantId to, Peer &peer)
{
    Datagram datagram;
    datagram.What = Datagram::Kind::Endpoints;
    datagram.First = me.Version;
    datagram.Last = peer.SentVersion;
    datagram.Endpoints = me.Endpoints;
    const auto isNews = [&](const EndpointInfoPtr &endpoint) { return endpoint->Since > peer.SentVersion; };
    datagram.News =
        static_cast<std::size_t>(std::count_if(me.Endpoints->begin(), me.Endpoints->end(), isNews));
    peer.SentVersion = me.Version;
    peer.RepairGap = _timings.DiscoveryRepair;
    if (!peer.RepairPending)
    {
        peer.RepairPending = true;
        Later(peer.RepairGap, {Event::Kind::EndpointRepairTimer, me.Id, to, peer.Birth, {}});
    }
    return datagram;
}

// Until the peer has confirmed the endpoints.
void NetworkCore::RepairEndpoints(ParticipantState &me, ParticipantId to, std::uint64_t birth)
{
    const auto found = me.Peers.find(to);
    if (found == me.Peers.end() || found->second.Birth != birth)
    {
        return;
    }
    Peer &peer = found->second;
    peer.RepairPending = peer.ConfirmedVersion != me.Version;
    if (peer.RepairPending)
    {
        Datagram query;
        query.What = Datagram::Kind::EndpointsQuery;
        Send(me, to, std::move(query));
        peer.RepairGap = std::min(2 * peer.RepairGap, _timings.LongestDiscoveryRepair);
        Later(peer.RepairGap, {Event::Kind::EndpointRepairTimer, me.Id, to, birth, {}});
    }
}

void NetworkCore::HearEndpointsAck(ParticipantState &me, Peer &peer, std::uint64_t version, bool asked)
{
    if (asked && version != me.Version)
    {
        // What it lacks was lost, unless it is still on its way.
        peer.ConfirmedVersion = version;
        peer.SentVersion = version;
        OfferEndpoints(me);
    }
    peer.ConfirmedVersion = std::max(peer.ConfirmedVersion, version);
}

void NetworkCore::AnswerEndpoints(const ParticipantState &me, ParticipantId from, const Peer &peer,
                                  bool asked)
{
    Datagram ack;
    ack.What = Datagram::Kind::EndpointsAck;
    ack.First = peer.TheirVersion;
    ack.Last = asked ? 1 : 0;
    Send(me, from, std::move(ack));
}

void NetworkCore::HearEndpoints(const ParticipantPtr &me, ParticipantId from, const Datagram &datagram)
{
    const auto known = me->Peers.find(from);
    if (known == me->Peers.end())
    {
        return;  // it asks until this participant has discovered it and answers
    }
    Peer &peer = known->second;
    if (datagram.First > peer.TheirVersion && datagram.Last <= peer.TheirVersion)
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
    AnswerEndpoints(*me, from, peer, false);
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
