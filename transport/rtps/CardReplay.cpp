#include "rtps/CardReplay.h"

#include <rabit/base/Earliest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"

namespace Rabit::Rtps
{

namespace
{

constexpr std::array<EntityId, 2> EndpointWriters{PublicationsWriter, SubscriptionsWriter};

// Seconds and their 2^-32 fractions, in the byte order of the list (9.3.2: a duration).
void PutLease(std::span<std::uint8_t> payload, std::chrono::milliseconds lease)
{
    const auto milliseconds = static_cast<std::uint64_t>(lease.count());
    VisitParameters(payload,
                    [&](const ListParameter &parameter)
                    {
                        if (parameter.Id == Parameters::LeaseDuration && parameter.Value.size() == 8)
                        {
                            const auto value = payload.subspan(EncapsulationSize + parameter.At + 4);
                            Write(value.first(4), milliseconds / 1000, IsLittleEndianList(payload));
                            Write(value.subspan(4, 4), (milliseconds % 1000 << 32) / 1000,
                                  IsLittleEndianList(payload));
                        }
                    });
}

std::string NameIn(std::span<const std::uint8_t> payload)
{
    std::string name;
    VisitParameters(payload,
                    [&name](const ListParameter &parameter)
                    {
                        if (parameter.Id == Parameters::EntityName && parameter.Value.size() > 4)
                        {
                            const auto text = parameter.Value.subspan(4);  // behind its length
                            name.assign(text.begin(), std::find(text.begin(), text.end(), 0));
                        }
                    });
    return name;
}

// The addresses at which a participant can be reached, as its announcement has them.
std::vector<HostAddress> HostsIn(std::span<const std::uint8_t> payload)
{
    constexpr std::uint32_t UdpOverIpv4 = 1;
    constexpr std::size_t LocatorSize = 24;
    constexpr std::size_t Most = 64;  // as the guard accepts
    std::vector<HostAddress> hosts;
    VisitParameters(payload,
                    [&](const ListParameter &parameter)
                    {
                        const bool isOwn = parameter.Id == Parameters::MetatrafficUnicastLocator ||
                                           parameter.Id == Parameters::DefaultUnicastLocator;
                        if (isOwn && parameter.Value.size() == LocatorSize && hosts.size() < Most &&
                            RtpsReader(parameter.Value, IsLittleEndianList(payload)).U32() == UdpOverIpv4)
                        {
                            HostAddress &host = hosts.emplace_back();
                            const auto address = parameter.Value.last(host.size());
                            std::copy(address.begin(), address.end(), host.begin());
                        }
                    });
    return hosts;
}

}  // namespace

bool CardReplay::Put(const GuidPrefix &peer, std::span<const std::uint8_t> card, TimePoint now)
{
    if (!HasRtpsHeader(card) || SenderOf(card) != peer)
    {
        return false;
    }
    std::vector<std::uint8_t> participant;
    std::vector<std::pair<EntityId, std::span<const std::uint8_t>>> endpoints;
    VisitSubmessages(
        card,
        [&](const ConstSubmessage &part)
        {
            const auto said = ReadAnnouncement(part.Whole);
            if (said && said->Writer == ParticipantWriter && participant.empty())
            {
                participant.assign(part.Whole.begin(), part.Whole.end());
            }
            else if (said && IsEndpointWriter(said->Writer) && endpoints.size() < OwnCard::MostEndpoints)
            {
                endpoints.emplace_back(said->Writer, part.Whole);
            }
        });
    if (participant.empty())
    {
        return false;
    }
    const auto payload = ReadAnnouncement(participant)->Payload;
    PutLease(payload, std::chrono::duration_cast<std::chrono::milliseconds>(_memory));
    Peer &known = _peers[peer];
    known.Name = NameIn(payload);
    known.Hosts = HostsIn(payload);
    known.Header.assign(card.begin(), card.begin() + RtpsHeaderSize);
    known.Participant = std::move(participant);
    std::map<EntityId, std::set<EntityId>> present;
    for (const auto &[writer, whole] : endpoints)
    {
        present[writer].insert(SubjectOf(whole));
    }
    for (const EntityId writer : EndpointWriters)
    {
        RemoveMissing(known.Streams[writer], writer, peer, present[writer]);
    }
    for (const auto &[writer, whole] : endpoints)
    {
        Stream &stream = known.Streams[writer];
        Announcement &endpoint = stream.Endpoints[SubjectOf(whole)];
        const std::uint64_t content = ContentOf(whole);
        if (endpoint.Number == 0 || endpoint.IsGone || endpoint.Content != content)
        {
            endpoint = {.Number = ++stream.Last,
                        .Content = content,
                        .IsGone = false,
                        .Bytes = {whole.begin(), whole.end()}};
        }
    }
    known.Retry.Begin(now);
    return true;
}

bool CardReplay::IsAt(const GuidPrefix &peer, const HostAddress &host) const
{
    constexpr std::uint8_t Loopback = 127;
    const auto found = _peers.find(peer);
    return found != _peers.end() &&
           (host[0] == Loopback || std::find(found->second.Hosts.begin(), found->second.Hosts.end(), host) !=
                                       found->second.Hosts.end());
}

// If the implementation acknowledges nothing, announcements of endpoints that are gone are dropped at the
// limit: it knows none of those endpoints.
void CardReplay::RemoveMissing(Stream &stream, EntityId writer, const GuidPrefix &peer,
                               const std::set<EntityId> &present)
{
    for (auto &[subject, endpoint] : stream.Endpoints)
    {
        if (!endpoint.IsGone && !present.contains(subject))
        {
            endpoint = {.Number = ++stream.Last, .Content = 0, .IsGone = true, .Bytes = {}};
            AppendEnd(endpoint.Bytes, writer, peer, subject, endpoint.Number);
        }
    }
    for (auto at = stream.Endpoints.begin();
         stream.Endpoints.size() > 2 * OwnCard::MostEndpoints && at != stream.Endpoints.end();)
    {
        at = at->second.IsGone ? stream.Endpoints.erase(at) : std::next(at);
    }
}

void CardReplay::End(const GuidPrefix &peer)
{
    EndFirst(peer);
    _peers.erase(peer);
}

void CardReplay::EndFirst(const GuidPrefix &peer)
{
    const auto found = _peers.find(peer);
    if (found == _peers.end())
    {
        return;
    }
    Message end{.From = peer, .Bytes = found->second.Header};
    AppendEnd(end.Bytes, ParticipantWriter, peer, ParticipantEntity, ++found->second.Announced);
    _ends.push_back(std::move(end));
}

std::string CardReplay::NameOf(const GuidPrefix &peer) const
{
    const auto found = _peers.find(peer);
    return found == _peers.end() ? "" : found->second.Name;
}

std::vector<GuidPrefix> CardReplay::Peers() const
{
    std::vector<GuidPrefix> peers;
    for (const auto &[name, peer] : _peers)
    {
        peers.push_back(name);
    }
    return peers;
}

std::size_t CardReplay::BytesOf(const GuidPrefix &peer) const
{
    const auto found = _peers.find(peer);
    std::size_t bytes = 0;
    if (found != _peers.end())
    {
        for (const auto &[writer, stream] : found->second.Streams)
        {
            for (const auto &[subject, endpoint] : stream.Endpoints)
            {
                bytes += endpoint.Bytes.size();
            }
        }
    }
    return bytes;
}

void CardReplay::GoOn(const GuidPrefix &peer, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found != _peers.end() && !found->second.Retry.Due() && !IsSettled(found->second))
    {
        found->second.Retry.Begin(now);
    }
}

bool CardReplay::IsSettled(const Peer &peer)
{
    return std::all_of(peer.Streams.begin(), peer.Streams.end(),
                       [](const auto &entry)
                       { return entry.second.IsConfirmed && entry.second.Acknowledged > entry.second.Last; });
}

void CardReplay::Answer(Peer &peer, TimePoint now)
{
    if (!peer.AnswerAt)
    {
        peer.AnswerAt = std::max(now, peer.Answered + ShortestGap);
    }
}

void CardReplay::Again(const GuidPrefix &peer, TimePoint now)
{
    const auto found = _peers.find(peer);
    if (found == _peers.end() || found->second.Retry.Due())
    {
        return;
    }
    for (auto &[writer, stream] : found->second.Streams)
    {
        stream.IsConfirmed = false;
    }
    found->second.IsKnown = false;
    found->second.Retry.Begin(now);
}

void CardReplay::Said(const EndpointSubmessage &said, TimePoint now)
{
    for (auto &[name, peer] : _peers)
    {
        if (said.To != GuidPrefix{} && said.To != name)
        {
            continue;
        }
        if (said.Kind == SubmessageKind::Heartbeat)
        {
            peer.Streams[said.Said.Writer].OwesAcknowledgement = true;
            Answer(peer, now);
        }
        else if (said.Kind == SubmessageKind::AckNack)
        {
            Stream &stream = peer.Streams[said.Said.Writer];
            peer.IsKnown = true;
            stream.IsConfirmed = true;
            stream.Acknowledged = std::max<std::int64_t>(said.Said.First, 1);
            std::erase_if(stream.Endpoints, [&stream](const auto &entry)
                          { return entry.second.IsGone && entry.second.Number < stream.Acknowledged; });
            if (stream.Acknowledged <= stream.Last || !said.IsFinal)
            {
                Answer(peer, now);
            }
            if (IsSettled(peer))
            {
                peer.Retry.Stop();
            }
            else if (!peer.Retry.Due())
            {
                peer.Retry.Begin(now + FirstRetry);
            }
        }
    }
}

std::optional<CardReplay::TimePoint> CardReplay::Due() const
{
    std::optional<TimePoint> due = _ends.empty() ? std::nullopt : std::optional(TimePoint{});
    for (const auto &[name, peer] : _peers)
    {
        due = Earliest({due, peer.AnswerAt, peer.Retry.Due()});
    }
    return due;
}

std::vector<CardReplay::Message> CardReplay::TakeDue(TimePoint now, const OwnCard &own)
{
    std::vector<Message> messages = std::exchange(_ends, {});
    for (auto &[name, peer] : _peers)
    {
        const bool retries = peer.Retry.IsDue(now);
        const bool answers = IsBy(peer.AnswerAt, now);
        if (retries)
        {
            peer.Retry.Done(now);
        }
        if (retries || answers)
        {
            peer.AnswerAt.reset();
            peer.Answered = now;
            Say(name, peer, retries, own, messages);
        }
    }
    return messages;
}

void CardReplay::Say(const GuidPrefix &name, Peer &peer, bool all, const OwnCard &own,
                     std::vector<Message> &messages)
{
    const auto begin = [&]
    {
        Message message{.From = name, .Bytes = peer.Header};
        AppendDestination(message.Bytes, _self);
        return message;
    };
    if (all && !std::exchange(peer.IsKnown, false))
    {
        // In a message of its own: the implementation has to know the participant before the rest.
        Message message{.From = name, .Bytes = peer.Header};
        AppendAnnouncement(message.Bytes, peer.Participant, ++peer.Announced);
        messages.push_back(std::move(message));
    }
    Message message = begin();
    const std::size_t empty = message.Bytes.size();
    for (auto &[writer, stream] : peer.Streams)
    {
        if (std::exchange(stream.OwesAcknowledgement, false))
        {
            const OwnCard::Acknowledged acknowledged = own.Of(writer);
            AppendAcknowledgement(message.Bytes, writer, acknowledged.Base, acknowledged.Missing, ++_count);
        }
        if (stream.IsConfirmed && stream.Acknowledged > stream.Last)
        {
            continue;
        }
        AppendHeartbeat(message.Bytes, writer, stream.Last, ++_count);
        std::map<std::int64_t, const Announcement *> lacking;
        for (const auto &[subject, endpoint] : stream.Endpoints)
        {
            if (endpoint.Number >= stream.Acknowledged)
            {
                lacking.emplace(endpoint.Number, &endpoint);
            }
        }
        std::int64_t next = stream.Acknowledged;
        for (const auto &[number, endpoint] : lacking)
        {
            if (message.Bytes.size() + endpoint->Bytes.size() > LargestMessage)
            {
                messages.push_back(std::exchange(message, begin()));
            }
            if (next < number)  // a newer announcement has replaced these
            {
                AppendGap(message.Bytes, writer, next, number);
            }
            AppendAnnouncement(message.Bytes, endpoint->Bytes, number);
            next = number + 1;
        }
    }
    if (message.Bytes.size() > empty)
    {
        messages.push_back(std::move(message));
    }
}

}  // namespace Rabit::Rtps
