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
    _series = std::min(2 * _series, _period);
    for (Duration since = _introduced ? now - *_introduced : Quiet;
         since >= SeriesRest && _series > ShortestGap; since -= SeriesRest)
    {
        _series /= 2;
    }
    _series = _introduced ? std::max(_series, ShortestGap) : ShortestGap;
    _introduced = now;
    _due = std::min(_due, std::max(now, _last ? *_last + _series : Duration(0)));
    _step = _series;
}

void BeatPace::StateWritten(Duration now)
{
    if (_period <= DefaultPeriod)
    {
        _stateDue = std::max(now + AfterState, _last ? *_last + GapForStates : now);
    }
}

void BeatPace::Sent(Duration now)
{
    if (now < Due())
    {
        _gap = std::min(2 * _gap, _period);
        _broughtForward = now;
    }
    else if (!_broughtForward || now - *_broughtForward >= Quiet)
    {
        _gap = ShortestGap;
    }
    _last = now;
    _stateDue.reset();
    _due = now + std::min(_step, _period);
    _step = _step < _period ? 2 * _step : Duration::max();
}

}  // namespace Rabit
