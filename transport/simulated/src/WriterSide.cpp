// NetworkCore: a writer sends and repairs, in the manner of RTPS 2.3, 8.4, without its encoding.
#include <algorithm>
#include <utility>

#include "NetworkCore.h"
#include "common/MulticastUse.h"

namespace Rabit::Simulated
{

namespace
{

auto FindInHistory(const WriterState &writer, std::uint64_t sequence)
{
    return std::lower_bound(writer.History.begin(), writer.History.end(), sequence,
                            [](const SamplePtr &sample, std::uint64_t wanted)
                            { return sample->Sequence < wanted; });
}

// The first sample that the reader may still get.
std::uint64_t FirstFor(const WriterState &writer, const ReaderProxy &reader)
{
    const auto first = FindInHistory(writer, reader.Acknowledged + 1);
    return first == writer.History.end() ? writer.LastSequence + 1 : (*first)->Sequence;
}

void PutIntoHistory(WriterState &writer, SamplePtr sample)
{
    const auto depth = static_cast<std::size_t>(writer.Info->Qos.Depth);
    auto &history = writer.History;
    if (!writer.Info->Keyed)
    {
        while (history.size() >= depth)
        {
            history.pop_front();
        }
    }
    else
    {
        const auto same = [&](const SamplePtr &kept) { return kept->Key == sample->Key; };
        auto count = static_cast<std::size_t>(std::count_if(history.begin(), history.end(), same));
        for (; count >= depth; --count)
        {
            history.erase(std::find_if(history.begin(), history.end(), same));
        }
    }
    history.push_back(std::move(sample));
}

// Drops unneeded samples. A volatile writer keeps a sample only while a matched reader has not acknowledged
// it. A transient-local one also keeps samples for late readers, until their disposal is acknowledged.
void LetGo(WriterState &writer)
{
    const bool keepsForLateReaders = writer.Info->Qos.Durability == Durability::TransientLocal;
    if (keepsForLateReaders && writer.Disposals.empty())
    {
        return;
    }
    std::uint64_t known = writer.LastSequence;
    for (const auto &[id, reader] : writer.Readers)
    {
        known = std::min(known, reader.Reliable ? reader.Acknowledged : writer.LastSequence);
    }
    for (; !writer.Disposals.empty() && writer.Disposals.front()->Sequence <= known;
         writer.Disposals.pop_front())
    {
        const SamplePtr &end = writer.Disposals.front();
        std::erase_if(writer.History, [&](const SamplePtr &kept)
                      { return kept->Key == end->Key && kept->Sequence <= end->Sequence; });
    }
    if (keepsForLateReaders)
    {
        return;
    }
    while (!writer.History.empty() && writer.History.front()->Sequence <= known)
    {
        writer.History.pop_front();
    }
}

}  // namespace

bool NetworkCore::Write(ParticipantState &participant, WriterState &writer,
                        const std::shared_ptr<Sample> &sample, const std::string *node,
                        std::uint32_t partsBefore)
{
    const std::lock_guard lock(_mutex);
    if (participant.Gone)
    {
        return false;
    }
    sample->Sequence = ++writer.LastSequence;
    PutIntoHistory(writer, sample);
    if (!sample->Alive)
    {
        writer.Disposals.push_back(sample);
    }
    const auto sessions = node == nullptr ? std::vector<ParticipantId>() : participant.Sessions.Of(*node);
    Letters letters;
    for (const auto &[id, reader] : writer.Readers)
    {
        if (node == nullptr || std::find(sessions.begin(), sessions.end(), id.Participant) != sessions.end())
        {
            letters.push_back({id.Participant, MakeData(writer, id, reader, sample)});
        }
    }
    const bool multicast = node == nullptr && IsMulticastForData(participant.Settings);
    if (participant.Turn.IsOpen && sample->Datagrams == 1)
    {
        Keep(participant, std::move(letters), multicast);
    }
    else
    {
        SendKept(participant);  // earlier samples
        SendTogether(participant, std::move(letters), multicast, partsBefore);
    }
    LetGo(writer);
    AwaitHeartbeat(writer, _timings.HeartbeatPeriod);
    return true;
}

// No reader sees a part: whether a sample is lost is decided with its last part.
bool NetworkCore::WritePart(const ParticipantState &participant, const WriterState &writer,
                            const Sample &sample)
{
    const std::lock_guard lock(_mutex);
    if (participant.Gone)
    {
        return false;
    }
    Medium *const medium = _media.Of(participant.NodeNumber);
    for (std::uint64_t i = CountDestinations(participant, writer); i > 0; --i)
    {
        Cost cost = CostOfPart(sample);
        cost.Bytes += SealOfPart(participant);
        Count(participant, cost);
        if (medium != nullptr && medium->IsInTheWay())
        {
            const auto flight = std::make_shared<Flight>();
            flight->From = participant.Id;
            flight->FromNode = participant.NodeNumber;
            Offer(*medium, flight, cost);
        }
    }
    return true;
}

std::size_t NetworkCore::BytesOfPart(const ParticipantState &participant, const WriterState &writer,
                                     const Sample &sample) const
{
    const std::lock_guard lock(_mutex);
    return CountDestinations(participant, writer) * (CostOfPart(sample).Bytes + MostOfSeal(participant));
}

int NetworkCore::MatchedReaders(const WriterState &writer) const
{
    const std::lock_guard lock(_mutex);
    return static_cast<int>(writer.Readers.size());
}

int NetworkCore::Destinations(const ParticipantState &participant, const WriterState &writer) const
{
    const std::lock_guard lock(_mutex);
    return static_cast<int>(CountDestinations(participant, writer));
}

int NetworkCore::MatchedWriters(const ReaderState &reader) const
{
    const std::lock_guard lock(_mutex);
    return static_cast<int>(reader.Writers.size());
}

Datagram NetworkCore::MakeData(const WriterState &writer, const EndpointId &to, const ReaderProxy &reader,
                               const SamplePtr &sample)
{
    Datagram datagram;
    datagram.What = Datagram::Kind::Data;
    datagram.Writer = writer.Info->Id;
    datagram.Reader = to;
    datagram.First = FirstFor(writer, reader);
    datagram.Content = sample;
    return datagram;
}

// Number of packets of a large sample that the reader still lacks: only those are sent. nullptr for others.
std::uint32_t *NetworkCore::MissingOf(const ParticipantState &me, const Datagram &datagram)
{
    if (datagram.What != Datagram::Kind::Data || datagram.Content->Datagrams == 1)
    {
        return nullptr;
    }
    const auto writer = me.Writers.find(datagram.Writer);
    if (writer == me.Writers.end())
    {
        return nullptr;
    }
    const auto reader = writer->second->Readers.find(datagram.Reader);
    const SamplePtr &sample = datagram.Content;
    return reader == writer->second->Readers.end()
               ? nullptr
               : &reader->second.Missing.try_emplace(sample->Sequence, sample->Datagrams).first->second;
}

void NetworkCore::NoteFragments(const ParticipantState &me, const Datagram &datagram, std::uint32_t lost)
{
    if (std::uint32_t *missing = MissingOf(me, datagram))
    {
        *missing = std::min(*missing, lost);
        ReaderProxy &reader = me.Writers.at(datagram.Writer)->Readers.at(datagram.Reader);
        if (lost == 0 || !reader.Reliable)
        {
            reader.Missing.erase(datagram.Content->Sequence);
        }
    }
}

bool NetworkCore::WaitsForHeartbeat(const WriterState &writer)
{
    return std::any_of(writer.Readers.begin(), writer.Readers.end(),
                       [&](const auto &entry)
                       { return entry.second.Reliable && entry.second.Acknowledged < writer.LastSequence; });
}

// The next heartbeat goes after this delay, or earlier if it was due earlier.
void NetworkCore::AwaitHeartbeat(WriterState &writer, Time delay)
{
    if (!WaitsForHeartbeat(writer))
    {
        return;
    }
    writer.HeartbeatGap = delay;
    if (writer.HeartbeatAt && *writer.HeartbeatAt <= _now + delay)
    {
        return;
    }
    writer.HeartbeatAt = _now + delay;
    Event event{Event::Kind::HeartbeatTimer, writer.Info->Id.Participant, 0, ++writer.HeartbeatTimer, {}};
    event.Content.Writer = writer.Info->Id;
    Later(delay, std::move(event));
}

void NetworkCore::SendHeartbeats(const ParticipantState &me, WriterState &writer)
{
    writer.HeartbeatAt.reset();
    Letters letters;
    for (const auto &[id, reader] : writer.Readers)
    {
        if (reader.Reliable && reader.Acknowledged < writer.LastSequence)
        {
            Datagram datagram;
            datagram.What = Datagram::Kind::Heartbeat;
            datagram.Writer = writer.Info->Id;
            datagram.Reader = id;
            datagram.First = FirstFor(writer, reader);
            datagram.Last = writer.LastSequence;
            letters.push_back({id.Participant, std::move(datagram)});
        }
    }
    SendTogether(me, std::move(letters), IsMulticastForData(me.Settings));
    AwaitHeartbeat(writer, std::min(2 * writer.HeartbeatGap, _timings.LongestHeartbeatPeriod));
}

void NetworkCore::HearAcknowledgement(const ParticipantState &me, WriterState &writer,
                                      const Datagram &datagram)
{
    const auto found = writer.Readers.find(datagram.Reader);
    if (found == writer.Readers.end() || datagram.First == 0)
    {
        return;
    }
    ReaderProxy &reader = found->second;
    const bool isNews = datagram.First - 1 > reader.Acknowledged || !datagram.Sequences.empty();
    reader.Acknowledged = std::max(reader.Acknowledged, datagram.First - 1);
    reader.Missing.erase(reader.Missing.begin(), reader.Missing.upper_bound(reader.Acknowledged));
    for (const std::uint64_t sequence : datagram.Sequences)
    {
        // Samples that left the history need no answer: all later data names the first one that it has.
        const auto sample = FindInHistory(writer, sequence);
        if (sequence > reader.Acknowledged && sample != writer.History.end() &&
            (*sample)->Sequence == sequence)
        {
            Send(me, found->first.Participant, MakeData(writer, found->first, reader, *sample),
                 _timings.ResponseDelay);
        }
    }
    LetGo(writer);
    if (isNews)
    {
        AwaitHeartbeat(writer, _timings.HeartbeatPeriod);
    }
}

}  // namespace Rabit::Simulated
