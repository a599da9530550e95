// NetworkCore: participants announce their endpoints.
#include <algorithm>
#include <utility>

#include "NetworkCore.h"

namespace Rabit::Simulated
{

namespace
{

// Bytes of the size of a packed card, different for each version of it.
std::vector<std::uint8_t> CardOf(const ParticipantState &me)
{
    constexpr std::size_t participant = 150;
    constexpr std::size_t endpoint = 60;
    std::vector<std::uint8_t> card(participant + endpoint * me.Endpoints->size());
    const Rtps::GuidPrefix self = PrefixOf(me.Id);
    const auto rest = std::copy(self.begin(), self.end(), card.begin());
    for (std::size_t i = 0; i < 8; ++i)
    {
        rest[static_cast<std::ptrdiff_t>(i)] = static_cast<std::uint8_t>(me.Version >> (8 * i));
    }
    return card;
}

}  // namespace

void NetworkCore::EndpointsChanged(ParticipantState &me, EndpointInfoPtr added, const EndpointId &removed)
{
    if (me.Gone)
    {
        return;  // it crashed: its objects are destroyed later, and no peer is told
    }
    auto endpoints = std::make_shared<EndpointList>(*me.Endpoints);
    if (added != nullptr)
    {
        endpoints->push_back(std::move(added));
    }
    std::erase_if(*endpoints, [&](const EndpointInfoPtr &endpoint) { return endpoint->Id == removed; });
    me.Endpoints = std::move(endpoints);
    ++me.Version;
    me.Cards.SetOwn(CardOf(me), CardTime());
    AwaitCards(me);
}

void NetworkCore::TakeEndpoints(const ParticipantPtr &me, Peer &peer,
                                const std::shared_ptr<const EndpointList> &endpoints)
{
    const auto before = std::exchange(peer.TheirEndpoints, endpoints);
    const auto byId = [](const EndpointInfoPtr &a, const EndpointInfoPtr &b) { return a->Id < b->Id; };
    EndpointList gone;
    std::set_difference(before->begin(), before->end(), endpoints->begin(), endpoints->end(),
                        std::back_inserter(gone), byId);
    EndpointList added;
    std::set_difference(endpoints->begin(), endpoints->end(), before->begin(), before->end(),
                        std::back_inserter(added), byId);
    for (const auto &endpoint : gone)
    {
        EndpointGone(me, endpoint->Id);
    }
    for (const auto &endpoint : added)
    {
        EndpointAppeared(me, peer, *endpoint);
    }
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
