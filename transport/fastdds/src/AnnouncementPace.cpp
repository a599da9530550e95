#include "AnnouncementPace.h"

#include <algorithm>

namespace Rabit::FastDds
{

AnnouncementPace::AnnouncementPace(std::chrono::milliseconds period, bool hasCard)
    : _firstInitial(
          std::min<std::chrono::steady_clock::duration>(hasCard ? InitialGapWithCard : FirstGap, period / 2)),
      _usual(period / 2),
      _gap({std::min<Backoff::Duration>(FirstGap, period / 2),
            std::min<Backoff::Duration>(LongestGap, period / 2)}),
      _initial({.First = 2 * _firstInitial,
                .Longest = Backoff::Duration::max(),
                .Most = hasCard ? InitialRoundsWithCard : InitialRounds})
{
}

void AnnouncementPace::Begin(std::uint64_t content, std::uint64_t heard, TimePoint now)
{
    if (!_begun)
    {
        _initial.Begin(now + _firstInitial);
    }
    else if (_initial.IsDue(now))
    {
        _initial.Done(now);
    }
    if (!_begun || now - *_begun >= Rest)
    {
        _gap.Reset();
    }
    else
    {
        _gap.Next();
    }
    _begun = now;
    _content = content;
    _heard = heard;
    _owed = false;
    _told.clear();
}

// The vendor also announces the participant whenever it finds another one. Peers with a card do not need
// that.
bool AnnouncementPace::IsWanted(std::uint64_t heard, TimePoint now) const
{
    return heard != _heard || _initial.IsDue(now) || now - *_begun >= _usual;
}

bool AnnouncementPace::MayGo(Destination destination, std::uint64_t content, std::uint64_t heard,
                             TimePoint now)
{
    if (!_begun || content != _content || _told.size() >= MostDestinations ||
        (now - *_begun >= _gap.Interval() && IsWanted(heard, now)))
    {
        Begin(content, heard, now);
    }
    if (_told.insert(destination).second)
    {
        return true;
    }
    _owed = _owed || heard != _heard;
    return false;
}

std::optional<AnnouncementPace::TimePoint> AnnouncementPace::Due() const
{
    std::optional<TimePoint> due;
    if (_begun && _owed)
    {
        due = *_begun + _gap.Interval();
    }
    if (_initial.Due() && (!due || *_initial.Due() < *due))
    {
        due = std::max(*_initial.Due(), *_begun + _gap.Interval());
    }
    return due;
}

}  // namespace Rabit::FastDds
