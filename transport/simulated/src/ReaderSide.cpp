// NetworkCore: a reader takes samples and requests missing ones, in the manner of RTPS 2.3, 8.4, without its
// encoding.
#include <algorithm>
#include <utility>

#include "NetworkCore.h"

namespace Rabit::Simulated
{

namespace
{

// An RTPS acknowledgement names at most this many missing samples.
constexpr std::size_t MostMissing = 256;

}  // namespace

void NetworkCore::HearSample(const ParticipantPtr &me, const ReaderPtr &reader, const Datagram &datagram)
{
    const auto found = reader->Writers.find(datagram.Writer);
    if (found == reader->Writers.end())
    {
        return;  // not matched, or not yet
    }
    WriterProxy &writer = found->second;
    const std::uint64_t sequence = datagram.Content->Sequence;
    if (writer.Reliable)
    {
        SkipTo(me, reader, found->first, writer, datagram.First);
        if (sequence >= writer.Expected)
        {
            writer.Early.try_emplace(sequence, datagram.Content);
        }
        HandOverInOrder(reader, found->first, writer);
        return;
    }
    if (writer.Started && sequence < writer.Expected)
    {
        return;  // duplicate, or too late
    }
    if (writer.Started && sequence > writer.Expected)
    {
        me->Log->SamplesLost(sequence - writer.Expected);
    }
    writer.Started = true;
    writer.Expected = sequence + 1;
    writer.ArrivedAt = _now;
    HandOver(reader, found->first, writer, datagram.Content);
}

void NetworkCore::HearHeartbeat(const ParticipantPtr &me, const ReaderPtr &reader, const Datagram &datagram)
{
    const auto found = reader->Writers.find(datagram.Writer);
    if (found == reader->Writers.end() || !found->second.Reliable)
    {
        return;
    }
    WriterProxy &writer = found->second;
    SkipTo(me, reader, found->first, writer, datagram.First);
    HandOverInOrder(reader, found->first, writer);
    Datagram answer;
    answer.What = Datagram::Kind::Acknowledgement;
    answer.Writer = datagram.Writer;
    answer.Reader = datagram.Reader;
    answer.First = writer.Expected;
    for (std::uint64_t sequence = writer.Expected;
         sequence <= datagram.Last && answer.Sequences.size() < MostMissing; ++sequence)
    {
        if (!writer.Early.contains(sequence))
        {
            answer.Sequences.push_back(sequence);
        }
    }
    Send(*me, datagram.Writer.Participant, std::move(answer), _timings.ResponseDelay);
}

// No sample below `first` will come any more: delivers the early ones below it and gives up the rest.
void NetworkCore::SkipTo(const ParticipantPtr &me, const ReaderPtr &reader, const EndpointId &from,
                         WriterProxy &writer, std::uint64_t first)
{
    if (!writer.Started)
    {
        writer.Started = true;
        writer.Expected = first;
        return;
    }
    if (first <= writer.Expected)
    {
        return;
    }
    std::uint64_t lost = first - writer.Expected;
    while (!writer.Early.empty() && writer.Early.begin()->first < first)
    {
        const auto early = writer.Early.begin();
        --lost;
        HandOver(reader, from, writer, early->second);
        writer.Early.erase(early);
    }
    writer.Expected = first;
    me->Log->SamplesLost(lost);
}

void NetworkCore::HandOverInOrder(const ReaderPtr &reader, const EndpointId &from, WriterProxy &writer)
{
    while (!writer.Early.empty() && writer.Early.begin()->first == writer.Expected)
    {
        const auto next = writer.Early.begin();
        HandOver(reader, from, writer, next->second);
        writer.Early.erase(next);
        ++writer.Expected;
    }
}

std::optional<Time> NetworkCore::LastArrival(const std::string &from, const std::string &to,
                                             const std::string &topic) const
{
    const std::lock_guard lock(_mutex);
    std::optional<Time> last;
    for (const auto &[id, participant] : _participants)
    {
        if (participant->Who->Node != to)
        {
            continue;
        }
        for (const auto &[entity, reader] : participant->Readers)
        {
            for (const auto &[writer, proxy] : reader->Writers)
            {
                if (reader->Info->Topic == topic && proxy.Node->Node == from)
                {
                    last = std::max(last, proxy.ArrivedAt);
                }
            }
        }
    }
    return last;
}

void NetworkCore::HandOver(const ReaderPtr &reader, const EndpointId &from, const WriterProxy &writer,
                           const SamplePtr &sample)
{
    writer.Node->Hear();
    _calls.push_back(
        [reader, sample, id = ToWriterId(from), node = writer.Node]
        {
            reader->Gate.Run(
                [&]
                {
                    SampleInfo info;
                    info.Writer = id;
                    info.Node = node->Node;
                    info.Incarnation = node->Incarnation;
                    info.SourceTime = sample->SourceTime;
                    info.Sequence = sample->Sequence;
                    info.Alive = sample->Alive;
                    info.Key = sample->Key;
                    if (reader->Info->Keyed)
                    {
                        sample->Alive ? reader->Instances.Alive(info.Key, id)
                                      : reader->Instances.Disposed(info.Key);
                    }
                    reader->Handler(sample->Bytes, info);
                });
        });
}

}  // namespace Rabit::Simulated
