#include "presence/BeatPace.h"

#include <algorithm>

namespace Rabit
{

void BeatPace::SetPeriod(Duration period)
{
    _period = std::clamp(period, ShortestPeriod, LongestPeriod);
    _gap = std::min(_gap, _period);
    if (_last)
    {
        _due = std::min(_due, *_last + _period);
    }
}

void BeatPace::Introduce(Duration now)
{
    _due = std::min(_due, std::max(now, Earliest()));
    _step = ShortestGap;
}

void BeatPace::Sent(Duration now)
{
    if (now < _due)
    {
        _gap = std::min(2 * _gap, _period);
        _broughtForward = now;
    }
    else if (!_broughtForward || now - *_broughtForward >= Quiet)
    {
        _gap = ShortestGap;
    }
    _last = now;
    _due = now + std::min(_step, _period);
    _step = _step < _period ? 2 * _step : Duration::max();
}

}  // namespace Rabit
