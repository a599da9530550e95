#include "ResendTimer.h"

#include <algorithm>

namespace Rabit
{

namespace
{

// More is for networks that others share. A link sends a datagram each time and falls silent once its peer
// has not been heard for some seconds; and where much is lost, waiting longer does not help.
constexpr int MostDoublings = 3;

}  // namespace

ResendTimer::ResendTimer(const LinkSettings &settings)
    : _first(settings.FirstResend), _min(settings.MinResend), _max(settings.MaxResend)
{
}

void ResendTimer::Measured(LinkTime roundTrip)
{
    _backOff = 0;
    roundTrip = std::max(roundTrip, LinkTime(1));
    if (_smoothed == LinkTime(0))
    {
        _smoothed = roundTrip;
        _variation = roundTrip / 2;
        return;
    }
    const LinkTime error = roundTrip > _smoothed ? roundTrip - _smoothed : _smoothed - roundTrip;
    _variation = (_variation * 3 + error) / 4;
    _smoothed = std::max((_smoothed * 7 + roundTrip) / 8, LinkTime(1));
}

void ResendTimer::BackOff()
{
    if (_backOff < MostDoublings && Timeout() < _max)
    {
        ++_backOff;
    }
}

LinkTime ResendTimer::PlainTimeout() const
{
    const LinkTime timeout = _smoothed == LinkTime(0) ? _first : _smoothed + 4 * _variation;
    return std::clamp(timeout, _min, _max);
}

LinkTime ResendTimer::Timeout() const
{
    return std::min<LinkTime>(PlainTimeout() * (1LL << _backOff), _max);
}

}  // namespace Rabit
