#include "clocks/PeerClock.h"

#include <algorithm>

namespace Rabit
{
namespace
{

constexpr PeerClock::Duration FilterPeriod = std::chrono::seconds(15);
// More than the drift that adds up while the filter remembers, and more than threads wait for a processor.
constexpr PeerClock::Duration Tolerance = std::chrono::milliseconds(100);

}  // namespace

void PeerClock::MinimumFilter::Add(Duration value, Duration now)
{
    if (_current && now - _periodStart >= FilterPeriod)
    {
        _previous = _current;
        _current.reset();
    }
    if (!_current)
    {
        _periodStart = now;
        _current = value;
    }
    _current = std::min(*_current, value);
}

void PeerClock::MinimumFilter::Restart(Duration value, Duration now)
{
    _previous.reset();
    _current = value;
    _periodStart = now;
}

std::optional<PeerClock::Duration> PeerClock::MinimumFilter::Value() const
{
    if (_current && _previous)
    {
        return std::min(*_current, *_previous);
    }
    return _current;
}

void PeerClock::OnBeat(const Reading &peer, Duration arrival)
{
    _lastDifference = arrival - peer.Source;
    _lastSource = peer.Source;
    _stoodStillHere = LastDelay() < -Tolerance;
    _difference.Add(_lastDifference, arrival);
    _sourceToWall = peer.Wall - peer.Source;
    Estimate();
}

void PeerClock::OnRoundTrip(Duration roundTrip, Duration now)
{
    if (roundTrip < Duration(0) || !_difference.Value())
    {
        return;
    }
    _roundTrip.Add(roundTrip, now);
    _lastRoundTrip = roundTrip;
    const Duration delay = LastDelay();
    const bool stoodStillThere = delay > roundTrip + Tolerance;
    if (stoodStillThere)
    {
        _stoodStill += delay;
        _stoodStillUntil = _lastSource;
        _difference.Restart(_lastDifference, now);
    }
    const Duration wayThere = roundTrip - _lastDifference;
    _wayThere.Add(wayThere, now);
    const bool stoodStillHere = *_wayThere.Value() + *_difference.Value() < Duration(0);
    if (stoodStillThere || stoodStillHere)
    {
        _wayThere.Restart(wayThere, now);
    }
    Estimate();
}

// Returns the estimated one-way delay of the beat with the smallest difference.
PeerClock::Duration PeerClock::QuickestDelay() const
{
    if (!_wayThere.Value())
    {
        return Duration(0);
    }
    const Duration both = *_wayThere.Value() + *_difference.Value();
    return (both < Duration(0) ? *_roundTrip.Value() : both) / 2;
}

void PeerClock::Estimate()
{
    _toLocal = *_difference.Value() - QuickestDelay();
}

std::optional<PeerClock::SourceRelation> PeerClock::Source() const
{
    return _toLocal
               ? std::optional(SourceRelation{
                     .ToLocal = *_toLocal, .StoodStill = _stoodStill, .StoodStillUntil = _stoodStillUntil})
               : std::nullopt;
}

std::optional<PeerClock::Duration> PeerClock::ToLocal(Duration source) const
{
    const std::optional<SourceRelation> relation = Source();
    return relation ? std::optional(relation->At(source)) : std::nullopt;
}

std::optional<PeerClock::Duration> PeerClock::SentAt(Duration source) const
{
    return _toLocal ? std::optional<Duration>(*_toLocal + source) : std::nullopt;
}

}  // namespace Rabit
