#include "backfill/FolderPosts.h"

#include <rabit/mcap/RecordedChannel.h>

#include <algorithm>
#include <limits>
#include <set>

#include "backfill/RecordedSeries.h"

namespace Rabit::Backfill
{
namespace
{

Stamp StampAt(std::uint64_t logTime, std::int64_t sourceToLog)
{
    return StampOf(static_cast<std::int64_t>(logTime) - sourceToLog);
}

}  // namespace

FolderPosts::FolderPosts(const std::string &folder, const std::string &node)
    : _node(node),
      _index(folder, node,
             [node](const Mcap::Channel &channel)
             {
                 const Mcap::RecordedChannel described = Mcap::Describe(channel);
                 return described.Kind == Mcap::ChannelKind::Posted && described.Node == node;
             })
{
}

Stamp FolderPosts::Part::LastStamp() const
{
    return StampAt(Piece->LastLog, SourceToLog);
}

bool FolderPosts::IsPast(const RecordingIndex::File &file) const
{
    return file.NewestLog <= _now || file.NewestLog - _now <= SettledAfter;
}

// By incarnation; the oldest first.
std::map<std::uint64_t, std::vector<FolderPosts::Part>> FolderPosts::PartsOf(const std::string &message) const
{
    std::map<std::uint64_t, std::vector<Part>> parts;
    for (const auto &[name, file] : _index.Files())
    {
        const auto clock = file.Metadata.find("rabit.clock");
        std::uint64_t incarnation = 0;
        std::int64_t sourceToLog = 0;
        if (!file.IsOwn || clock == file.Metadata.end() ||
            !ReadNumber(Mcap::ValueOf(clock->second, "incarnation"), incarnation) ||
            !ReadNumber(Mcap::ValueOf(clock->second, "source_to_log_ns"), sourceToLog))
        {
            continue;
        }
        std::set<std::uint16_t> channels;
        for (const auto &[number, channel] : file.Channels)
        {
            if (channel.Topic == _node + "/" + message)
            {
                channels.insert(number);
            }
        }
        for (const RecordingIndex::Piece &piece : file.Pieces)
        {
            const bool isUnknown = piece.IsOfAnyChannel || (!file.Channels.contains(piece.Channel) &&
                                                            !file.OtherChannels.contains(piece.Channel));
            if (channels.contains(piece.Channel) || isUnknown)
            {
                parts[incarnation].push_back({&file, &piece, sourceToLog, isUnknown});
            }
        }
    }
    return parts;
}

RecordingIndex::Access FolderPosts::Visit(const Part &part,
                                          const std::function<void(const Mcap::Message &message)> &visit)
{
    return part.IsOfUnknownChannel ? RecordingIndex::Access::Damaged
                                   : _index.Visit(*part.File, *part.Piece, visit);
}

// The first message may have been posted long before the recording began.
std::optional<Stamp> FolderPosts::FirstStamp(const std::vector<Part> &parts)
{
    Stamp first = std::numeric_limits<Stamp>::max();
    for (std::size_t i = 0; i < std::min(parts.size(), FirstParts); ++i)
    {
        const Part &part = parts[i];
        const std::pair key(part.File->Path + ":" + std::to_string(part.Piece->Channel), part.Piece->Offset);
        if (const auto known = _firsts.find(key); known != _firsts.end())
        {
            first = std::min(first, known->second);
            continue;
        }
        Stamp stamp = StampAt(part.Piece->FirstLog, part.SourceToLog);
        const RecordingIndex::Access access =
            Visit(part, [&stamp, &part](const Mcap::Message &message)
                  { stamp = std::min(stamp, StampAt(message.PublishTime, part.SourceToLog)); });
        if (access == RecordingIndex::Access::Failed)
        {
            return std::nullopt;
        }
        if (access == RecordingIndex::Access::Done)
        {
            _firsts.emplace(key, stamp);
        }
        first = std::min(first, stamp);
    }
    return first;
}

std::optional<std::vector<PostsCodec::Span>> FolderPosts::Spans(const std::string &message,
                                                                std::uint64_t last)
{
    if (!_index.Refresh())
    {
        return std::nullopt;
    }
    std::uint64_t newest = 0;
    for (const auto &[name, file] : _index.Files())
    {
        newest = std::max(newest, file.IsOwn && IsPast(file) ? file.NewestLog : 0);
    }
    last = std::min<std::uint64_t>(last, newest / 1'000'000'000);
    const std::uint64_t oldest = newest - last * 1'000'000'000;
    std::vector<PostsCodec::Span> spans;
    for (const auto &[incarnation, parts] : PartsOf(message))
    {
        const bool isPresent = incarnation == _incarnation;
        const Part &end = *std::max_element(parts.begin(), parts.end(),
                                            [](const Part &one, const Part &other)
                                            { return one.Piece->LastLog < other.Piece->LastLog; });
        if (end.Piece->LastLog < oldest)
        {
            continue;
        }
        const std::optional<Stamp> first = FirstStamp(parts);
        if (!first)
        {
            return std::nullopt;
        }
        Range range;
        range.First = std::max(*first, StampAt(oldest, parts.front().SourceToLog));
        range.End = isPresent ? StampAt(std::max(newest, SettledAfter) - SettledAfter, end.SourceToLog)
                              : end.LastStamp() + 1;
        range.End = std::max(range.End, range.First);
        spans.push_back({incarnation, range, !isPresent});
    }
    if (spans.size() > PostsCodec::MostSpans)
    {
        spans.erase(spans.begin(), spans.end() - PostsCodec::MostSpans);
    }
    return spans;
}

PostStore::Found FolderPosts::Read(const std::string &message, std::uint64_t incarnation, Range range,
                                   const std::vector<Stamp> &had, std::size_t most)
{
    Found found{.First = range.First, .Posts = {}};
    std::vector<Part> parts = std::move(PartsOf(message)[incarnation]);
    // The first parts may hold a post from before the recording: they are always looked at.
    std::vector<Part> chosen;
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
        const bool isAfter = StampAt(parts[i].Piece->FirstLog, parts[i].SourceToLog) >
                             range.End + StepsIn(static_cast<std::int64_t>(SettledAfter));
        if (parts[i].LastStamp() >= range.First && (!isAfter || i < FirstParts))
        {
            chosen.push_back(parts[i]);
        }
    }
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const Part &one, const Part &other)
                     { return one.Piece->LastLog > other.Piece->LastLog; });
    std::map<Stamp, Post> posts;
    std::map<Stamp, Post>::iterator first;
    const auto fit = [&]
    {
        std::size_t bytes = 0;
        first = posts.end();
        while (first != posts.begin())
        {
            const std::size_t size = std::prev(first)->second.Bytes.size() + PostOverhead;
            if (bytes > 0 && bytes + size > most)
            {
                return false;
            }
            bytes += size;
            --first;
        }
        return true;
    };
    Range damaged;  // the newest part that is
    bool goesOn = true;
    for (std::size_t i = 0; i < chosen.size() && goesOn; ++i)
    {
        const Part &part = chosen[i];
        const RecordingIndex::Access access =
            Visit(part,
                  [&](const Mcap::Message &one)
                  {
                      const std::int64_t time = static_cast<std::int64_t>(one.PublishTime) - part.SourceToLog;
                      const Stamp stamp = StampOf(time);
                      if (range.Contains(stamp) && !std::binary_search(had.begin(), had.end(), stamp))
                      {
                          posts.try_emplace(stamp, Post{time, {one.Data.begin(), one.Data.end()}});
                      }
                  });
        if (access == RecordingIndex::Access::Failed)
        {
            return {.First = range.First, .Posts = {}, .Is = Found::Result::NotNow};
        }
        if (access == RecordingIndex::Access::Damaged)
        {
            // It begins behind the last post before it, since only the index tells what was in it.
            const Stamp before =
                i + 1 < chosen.size()
                    ? std::min(chosen[i + 1].LastStamp() + 1, StampAt(part.Piece->FirstLog, part.SourceToLog))
                    : range.First;
            const Range lost{std::max(range.First, before), std::min(range.End, part.LastStamp() + 1)};
            if (lost.IsEmpty())
            {
                continue;  // it was chosen for the time between the last post and the record
            }
            damaged = lost;
            break;
        }
        // Enough, if the parts that are left hold only older posts.
        goesOn = fit() || (i + 1 < chosen.size() && chosen[i + 1].LastStamp() >= first->first);
    }
    if (!fit())
    {
        found.First = first->first;
    }
    // A post is recorded a moment later: the last ones of that time may be in the next part.
    if (const auto behind = posts.lower_bound(damaged.First);
        behind != posts.end() && behind->first < damaged.End)
    {
        damaged.End = behind->first;
    }
    // An answer is about one range. Posts behind the damaged part come first, then the part, then the rest.
    const bool isWithin = damaged.End > found.First;
    if (isWithin && damaged.End == range.End)
    {
        return {.First = damaged.First, .Posts = {}, .Is = Found::Result::Damaged};
    }
    if (isWithin)
    {
        found.First = damaged.End;
        first = posts.lower_bound(damaged.End);
    }
    for (; first != posts.end(); ++first)
    {
        found.Posts.push_back(std::move(first->second));
    }
    return found;
}

}  // namespace Rabit::Backfill
