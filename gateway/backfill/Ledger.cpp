#include "backfill/Ledger.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace Rabit::Backfill
{

Ledger::Track *Ledger::FindOrAdd(const Series &series)
{
    const auto found = _tracks.find(series);
    if (found != _tracks.end())
    {
        return &found->second;
    }
    return _tracks.size() < MostSeries ? &_tracks[series] : nullptr;
}

void Ledger::Clear()
{
    const std::lock_guard lock(_mutex);
    _tracks.clear();
}

bool Ledger::Take(const Series &series, Stamp stamp)
{
    const std::lock_guard lock(_mutex);
    Track *track = FindOrAdd(series);
    if (track == nullptr)
    {
        return true;
    }
    if (track->Whole.Contains(stamp) || !track->Had.insert(stamp).second)
    {
        return false;
    }
    if (track->Had.size() > MostStamps)
    {
        track->Floor = *track->Had.begin() + 1;
        track->Had.erase(track->Had.begin());
    }
    if (track->Span)
    {
        track->Span->End = std::max(track->Span->End, stamp + 1);
    }
    return true;
}

void Ledger::Undo(const Series &series, Stamp stamp)
{
    const std::lock_guard lock(_mutex);
    if (const auto found = _tracks.find(series); found != _tracks.end())
    {
        found->second.Had.erase(stamp);
    }
}

void Ledger::SetWhole(const Series &series, Range range)
{
    const std::lock_guard lock(_mutex);
    if (Track *track = FindOrAdd(series); track != nullptr && !range.IsEmpty())
    {
        track->Whole.Add(range);
        track->Had.erase(track->Had.lower_bound(range.First), track->Had.lower_bound(range.End));
    }
}

void Ledger::SetSpan(const Series &series, Range stamps)
{
    const std::lock_guard lock(_mutex);
    Track *track = FindOrAdd(series);
    if (track == nullptr || stamps.IsEmpty())
    {
        return;
    }
    if (!track->Had.empty())
    {
        stamps.End = std::max(stamps.End, *track->Had.rbegin() + 1);
    }
    track->Span = track->Span ? Range{std::min(track->Span->First, stamps.First),
                                      std::max(track->Span->End, stamps.End)}
                              : stamps;
}

Ledger::Gap Ledger::GapOf(const Series &series, const Track &track, Range gap)
{
    const auto end = track.Had.lower_bound(gap.End);
    auto first = end;
    for (std::size_t count = 0; first != track.Had.begin() && *std::prev(first) >= gap.First; ++count)
    {
        if (count == MostHad)
        {
            gap.First = *first;
            break;
        }
        --first;
    }
    return {series, gap, {first, end}};
}

std::optional<Ledger::Gap> Ledger::NewestGapOf(const Series &series, const Track &track, bool isPresent,
                                               bool andNewest)
{
    if (!track.Span)
    {
        return std::nullopt;
    }
    Range within{std::max(track.Span->First, track.Floor), track.Span->End};
    auto gap = track.Whole.NewestGap(within);
    const bool isNewest = gap && isPresent && gap->End == track.Span->End;
    if (isNewest && !andNewest)
    {
        within.End = gap->First;
        gap = track.Whole.NewestGap(within);
    }
    if (!gap)
    {
        return std::nullopt;
    }
    Gap found = GapOf(series, track, *gap);
    found.IsNewest = isNewest && andNewest;
    return found;
}

std::optional<Ledger::Gap> Ledger::NewestGap(const std::string &node, const std::string &message,
                                             std::uint64_t present, bool andNewest) const
{
    const std::lock_guard lock(_mutex);
    if (const auto now = _tracks.find({node, message, present}); now != _tracks.end())
    {
        if (auto gap = NewestGapOf(now->first, now->second, true, andNewest))
        {
            return gap;
        }
    }
    const auto begin = _tracks.lower_bound({node, message, 0});
    auto track = _tracks.upper_bound({node, message, std::numeric_limits<std::uint64_t>::max()});
    while (track != begin)
    {
        --track;
        if (track->first.Incarnation != present)
        {
            if (auto gap = NewestGapOf(track->first, track->second, false, andNewest))
            {
                return gap;
            }
        }
    }
    return std::nullopt;
}

std::size_t Ledger::Stamps() const
{
    const std::lock_guard lock(_mutex);
    std::size_t stamps = 0;
    for (const auto &[series, track] : _tracks)
    {
        stamps += track.Had.size();
    }
    return stamps;
}

}  // namespace Rabit::Backfill
