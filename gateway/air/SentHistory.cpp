#include "air/SentHistory.h"

#include <algorithm>

namespace Rabit
{

SentHistory::SentHistory() : _marks(Steps) {}

void SentHistory::Add(std::size_t bytes, Duration now)
{
    if (now >= _nextMark)
    {
        if (_count == Steps)
        {
            _begin = (_begin + 1) % Steps;
            --_count;
        }
        _marks[(_begin + _count++) % Steps] = {now, _total};
        _nextMark = now + Step;
    }
    _total += bytes;
    _last = now;
}

double SentHistory::Between(Duration from, Duration to) const
{
    return _count == 0 || to <= from ? 0.0 : Before(to) - Before(from);
}

double SentHistory::CarriedAtLeast(Duration from, Duration to, Duration arrived) const
{
    if (_count == 0 || to <= from)
    {
        return 0.0;
    }
    const auto rate = [arrived](double bytes, Duration since)
    { return bytes / std::chrono::duration<double>(arrived - since).count(); };
    const double before = Before(to);
    double most = rate(before - Before(from), from);
    for (std::size_t i = FirstAfter(from); i < _count && Nth(i).At < to; ++i)
    {
        most = std::max(most, rate(before - static_cast<double>(Nth(i).Total), Nth(i).At));
    }
    return most;
}

SentHistory::Duration SentHistory::LongestPause(Duration from, Duration to) const
{
    Duration longest{0};
    Duration since = from;
    for (std::size_t i = FirstAfter(from); i < _count && Nth(i).At < to; ++i)
    {
        longest = std::max(longest, Nth(i).At - since);
        since = Nth(i).At + Step;
    }
    return std::max(longest, to - since);
}

// The number of the first mark after that time.
std::size_t SentHistory::FirstAfter(Duration time) const
{
    std::size_t low = 0;
    std::size_t high = _count;
    while (low < high)
    {
        const std::size_t middle = (low + high) / 2;
        if (Nth(middle).At <= time)
        {
            low = middle + 1;
        }
        else
        {
            high = middle;
        }
    }
    return low;
}

// The bytes of a step are spread over the part of it that has passed.
double SentHistory::Before(Duration time) const
{
    const std::size_t low = FirstAfter(time);
    if (low == 0)
    {
        return static_cast<double>(Nth(0).Total);
    }
    const Mark &mark = Nth(low - 1);
    const bool isLast = low == _count;
    const std::uint64_t after = isLast ? _total : Nth(low).Total;
    const Duration end = isLast ? _last : std::min(mark.At + Step, Nth(low).At);
    const double bytes = static_cast<double>(after - mark.Total);
    const double share = time >= end ? 1.0
                                     : static_cast<double>((time - mark.At).count()) /
                                           static_cast<double>((end - mark.At).count());
    return static_cast<double>(mark.Total) + share * bytes;
}

}  // namespace Rabit
