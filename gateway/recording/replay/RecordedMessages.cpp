#include "recording/replay/RecordedMessages.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace Rabit::Replay
{
namespace
{

// How far LastBefore looks back at first, in nanoseconds; each further look is four times as long.
constexpr Time FirstLook = 2'000'000'000;

}  // namespace

RecordedMessages::RecordedMessages(std::vector<File> files, const ReplayPlan &plan)
    : _files(std::move(files)), _plan(plan), _given(plan.Streams.size())
{
}

Time RecordedMessages::First() const
{
    Time first = 0;
    for (const File &file : _files)
    {
        const Mcap::Statistics &counted = file.Contents->Statistics;
        if (counted.MessageCount > 0)
        {
            first = first == 0 ? counted.StartTime : std::min(first, counted.StartTime);
        }
    }
    return first;
}

Time RecordedMessages::Last() const
{
    Time last = 0;
    for (const File &file : _files)
    {
        last = std::max(last, file.Contents->Statistics.EndTime);
    }
    return last;
}

void RecordedMessages::Begin(Time from)
{
    for (const Open &open : _open)
    {
        NoteProblems(*open.Cursor);
    }
    _open.clear();
    _given.assign(_plan.Streams.size(), std::nullopt);
    for (std::size_t file = 0; file < _files.size(); ++file)
    {
        Mcap::MessageCursor::Selection selection;
        selection.From = from;
        selection.Wants = [this, file](std::uint16_t channel)
        { return _plan.Channels[file].count(channel) > 0; };
        _open.push_back({std::make_unique<Mcap::MessageCursor>(*_files[file].Bytes, *_files[file].Contents,
                                                               std::move(selection)),
                         std::nullopt});
        Advance(file);
    }
}

void RecordedMessages::Advance(std::size_t file)
{
    _open[file].Head = _open[file].Cursor->Next();
    if (!_open[file].Head)
    {
        NoteProblems(*_open[file].Cursor);
    }
}

std::optional<ReplayItem> RecordedMessages::Next()
{
    for (;;)
    {
        std::size_t first = _open.size();
        for (std::size_t file = 0; file < _open.size(); ++file)
        {
            const auto &head = _open[file].Head;
            if (head && (first == _open.size() || head->LogTime < _open[first].Head->LogTime))
            {
                first = file;
            }
        }
        if (first == _open.size())
        {
            return std::nullopt;
        }
        ReplayItem item = ItemOf(first, *_open[first].Head);
        Advance(first);
        std::optional<ReplayItem> &given = _given[item.Stream];
        const bool isRepeated = given && given->PublishTime == item.PublishTime && given->Data == item.Data &&
                                _plan.Streams[item.Stream].What == ReplayStream::Kind::Message;
        if (!isRepeated)
        {
            given = item;
            return item;
        }
    }
}

ReplayItem RecordedMessages::ItemOf(std::size_t file, const Mcap::Message &message) const
{
    return {_plan.Channels[file].at(message.ChannelId), message.LogTime, message.PublishTime,
            Mcap::Bytes(message.Data.begin(), message.Data.end())};
}

std::vector<ReplayItem> RecordedMessages::LastBefore(Time time)
{
    std::vector<std::optional<ReplayItem>> last(_plan.Streams.size());
    std::set<std::size_t> missing;
    for (std::size_t stream = 0; stream < _plan.Streams.size(); ++stream)
    {
        if (_plan.Streams[stream].What != ReplayStream::Kind::Queue)
        {
            missing.insert(stream);
        }
    }
    Time look = FirstLook;
    for (Time before = time; before > First() && !missing.empty(); look *= 4)
    {
        const Time from = before > look ? before - look : 0;
        bool any = false;
        for (std::size_t file = 0; file < _files.size(); ++file)
        {
            if (MayHold(file, before, missing))
            {
                any = true;
                TakeLast(file, from, before, missing, last);
            }
        }
        if (!any)
        {
            break;
        }
        std::erase_if(missing, [&last](std::size_t stream) { return last[stream].has_value(); });
        before = from;
    }
    std::vector<ReplayItem> found;
    for (std::optional<ReplayItem> &item : last)
    {
        if (item)
        {
            found.push_back(std::move(*item));
        }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const ReplayItem &left, const ReplayItem &right)
                     { return left.LogTime < right.LogTime; });
    return found;
}

// True if a chunk that begins before that time may hold one of the streams, as far as the index tells.
bool RecordedMessages::MayHold(std::size_t file, Time before, const std::set<std::size_t> &streams) const
{
    const auto holds = [&](const Mcap::ChunkIndex &chunk)
    {
        return chunk.MessageIndexOffsets.empty() ||
               std::any_of(chunk.MessageIndexOffsets.begin(), chunk.MessageIndexOffsets.end(),
                           [&](const auto &entry)
                           {
                               const auto stream = _plan.Channels[file].find(entry.first);
                               return stream != _plan.Channels[file].end() &&
                                      streams.count(stream->second) > 0;
                           });
    };
    const auto &chunks = _files[file].Contents->Chunks;
    return std::any_of(chunks.begin(), chunks.end(),
                       [&](const Mcap::ChunkIndex &chunk)
                       { return chunk.StartTime < before && holds(chunk); });
}

void RecordedMessages::TakeLast(std::size_t file, Time from, Time before,
                                const std::set<std::size_t> &streams,
                                std::vector<std::optional<ReplayItem>> &last)
{
    Mcap::MessageCursor::Selection selection;
    selection.From = from;
    selection.To = before - 1;
    selection.Wants = [this, file, &streams](std::uint16_t channel)
    {
        const auto stream = _plan.Channels[file].find(channel);
        return stream != _plan.Channels[file].end() && streams.count(stream->second) > 0;
    };
    Mcap::MessageCursor cursor(*_files[file].Bytes, *_files[file].Contents, std::move(selection));
    while (const auto message = cursor.Next())
    {
        std::optional<ReplayItem> &known = last[_plan.Channels[file].at(message->ChannelId)];
        if (!known || known->LogTime <= message->LogTime)
        {
            known = ItemOf(file, *message);
        }
    }
    NoteProblems(cursor);
}

void RecordedMessages::NoteProblems(const Mcap::MessageCursor &cursor)
{
    for (const std::string &problem : cursor.Problems())
    {
        if (_problems.size() < Mcap::Contents::MostProblems)
        {
            _problems.insert(problem);
        }
    }
}

}  // namespace Rabit::Replay
