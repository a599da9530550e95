#include "air/SlidingSecond.h"

namespace Rabit
{

void SlidingSecond::Forget(Duration now)
{
    while (_count > 0 && _entries[_begin].Last + Length <= now)
    {
        _scheduled -= _entries[_begin].Scheduled;
        _unscheduled -= _entries[_begin].Unscheduled;
        _begin = (_begin + 1) % _entries.size();
        --_count;
    }
}

void SlidingSecond::Add(std::uint64_t scheduled, std::uint64_t unscheduled, Duration now)
{
    Forget(now);
    if (_count == 0 || (now - At(_count - 1).First >= Together && _count < _entries.size()))
    {
        At(_count++) = {now, now, 0, 0};
    }
    Entry &entry = At(_count - 1);
    entry.Last = now;
    entry.Scheduled += scheduled;
    entry.Unscheduled += unscheduled;
    _scheduled += scheduled;
    _unscheduled += unscheduled;
}

std::uint64_t SlidingSecond::Scheduled(Duration now)
{
    Forget(now);
    return _scheduled;
}

std::uint64_t SlidingSecond::Unscheduled(Duration now)
{
    Forget(now);
    return _unscheduled;
}

}  // namespace Rabit
