#include "guard/SampleNumbers.h"

#include <algorithm>

namespace Rabit::Rtps
{

namespace
{

constexpr int OftenEnough = 3;
// Largest distance of a writer's clock from its last sample's time plus the time elapsed. A clock that was
// set is believed with the second sample.
constexpr std::chrono::seconds Doubtful{10};

std::uint64_t ToStamp(std::chrono::milliseconds time)
{
    return (static_cast<std::uint64_t>(time.count()) << 32) / 1000;
}

bool IsNear(std::uint64_t a, std::uint64_t b, std::uint64_t distance)
{
    return std::max(a, b) - std::min(a, b) <= distance;
}

}  // namespace

std::int64_t SampleNumbers::Of(std::int64_t number, std::uint64_t stamp, TimePoint now)
{
    const Sample sample{number, stamp};
    if (number > _highest)
    {
        GoOn(sample, now);
    }
    else if (number == _highest)
    {
        _belowInARow = 0;
    }
    else if (GoesBack(sample, now))
    {
        _added += _highest + 1 - number;
        _highest = number;
        _latest = stamp;
        _wentOn = now;
        _belowInARow = 0;
    }
    return number + _added;
}

void SampleNumbers::GoOn(const Sample &sample, TimePoint now)
{
    const auto elapsed = std::chrono::duration_cast<std::chrono::milliseconds>(now - _wentOn);
    // Limited to a day, which keeps the arithmetic in range.
    const auto expected = std::min<std::chrono::milliseconds>(elapsed, std::chrono::hours(24));
    const std::uint64_t distance = ToStamp(Doubtful + 2 * expected);
    const bool isFirst = _highest == 0;
    const bool isNear = IsNear(sample.Stamp, _latest, distance);
    if (!isFirst && (!isNear || sample.Stamp < _latest))
    {
        _settled = now + Unsettled;
    }
    if (isFirst || isNear || (_doubtful != 0 && IsNear(sample.Stamp, _doubtful, distance)))
    {
        _latest = sample.Stamp;
        _doubtful = 0;
    }
    else
    {
        _doubtful = sample.Stamp;
    }
    _highest = sample.Number;
    _wentOn = now;
    _belowInARow = 0;
}

bool SampleNumbers::GoesBack(const Sample &sample, TimePoint now)
{
    if (sample.Stamp <= _latest || now < _settled)
    {
        return false;
    }
    const bool isLater = sample.Number > _below.Number && sample.Stamp > _below.Stamp;
    if (_belowInARow > 0 && sample.Stamp == _below.Stamp && sample.Number >= _below.Number)
    {
        // Another fragment of it, or a sample written at the same time.
        _below.Number = sample.Number;
        return false;
    }
    _belowInARow = _belowInARow > 0 && isLater ? _belowInARow + 1 : 1;
    _below = sample;
    return _belowInARow >= OftenEnough;
}

}  // namespace Rabit::Rtps
