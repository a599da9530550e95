// NetworkCore: endpoints of different participants match.
#include <utility>

#include "NetworkCore.h"
#include "PartitionMatch.h"

namespace Rabit::Simulated
{

namespace
{

bool IsReliable(const EndpointInfo &endpoint)
{
    return endpoint.Qos.Reliability == Reliability::Reliable;
}

bool IsTransientLocal(const EndpointInfo &endpoint)
{
    return endpoint.Qos.Durability == Durability::TransientLocal;
}

RemoteEndpoint Described(const EndpointInfo &endpoint, const std::string &node)
{
    return {ToWriterId(endpoint.Id),  endpoint.IsWriter,       endpoint.Topic,      endpoint.Type,
            endpoint.Qos.Reliability, endpoint.Qos.Durability, endpoint.Partitions, node};
}

}  // namespace

void NetworkCore::EndpointAppeared(const ParticipantPtr &me, const Peer &peer, const EndpointInfo &remote)
{
    _calls.push_back([me, endpoint = Described(remote, peer.Who->Node)]
                     { me->Topics.RemoteAppeared(endpoint); });
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
            Send(*me, remote.Id.Participant, MakeData(writer, remote.Id, proxy->second, sample));
        }
        AwaitHeartbeat(writer, _timings.HeartbeatPeriod);
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

}  // namespace Rabit::Simulated
