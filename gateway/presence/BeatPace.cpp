#include "presence/BeatPace.h"

#include <algorithm>

namespace Rabit
{
namespace
{

// Halved this many times, the longest period is shorter than the shortest gap.
constexpr BeatPace::Duration::rep MostRests = 16;

}  // namespace

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
    const auto rests = _introduced ? std::min((now - *_introduced) / SeriesRest, MostRests) : MostRests;
    _series = std::max(std::min(2 * _series, _period) / (1 << rests), ShortestGap);
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

void BeatPace::Sent(Duration now, Duration delay, bool isWanted)
{
    if (now < Due())
    {
        const Duration quick = std::min(_gap * 3 / 2, ++_quick < QuickBeats ? QuickGap : LongestPeriod);
        _gap = std::min({std::max(quick, 2 * delay), _period, _longestGap});
        isWanted = true;
    }
    if (isWanted)
    {
        _wanted = now;
    }
    else
    {
        CalmDown(now);
    }
    Begin(now);
}

void BeatPace::SentEarly(Duration now)
{
    CalmDown(now);
    Begin(now);
}

void BeatPace::CalmDown(Duration now)
{
    if (!_wanted || now - *_wanted >= Quiet)
    {
        _gap = ShortestGap;
        _quick = 0;
    }
}

// The time until the next beat.
void BeatPace::Begin(Duration now)
{
    _last = now;
    _promised = now + _period;
    _stateDue.reset();
    _due = now + std::min(_step, _period);
    _step = _step < _period ? 2 * _step : Duration::max();
}

}  // namespace Rabit
