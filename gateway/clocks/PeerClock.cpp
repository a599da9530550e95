#include "clocks/PeerClock.h"

#include <algorithm>

namespace Rabit
{
namespace
{

constexpr PeerClock::Duration FilterPeriod = std::chrono::seconds(15);

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
    _difference.Add(arrival - peer.Monotonic, arrival);
    _monotonicToSource = peer.Source - peer.Monotonic;
    _sourceToWall = peer.Wall - peer.Source;
}

void PeerClock::OnRoundTrip(Duration roundTrip, Duration now)
{
    if (roundTrip >= Duration(0))
    {
        _roundTrip.Add(roundTrip, now);
        _lastRoundTrip = roundTrip;
    }
}

std::optional<PeerClock::Duration> PeerClock::MonotonicToLocal() const
{
    const std::optional<Duration> difference = _difference.Value();
    if (!difference)
    {
        return std::nullopt;
    }
    return *difference - _roundTrip.Value().value_or(Duration(0)) / 2;
}

std::optional<PeerClock::Duration> PeerClock::SourceToLocal() const
{
    const std::optional<Duration> offset = MonotonicToLocal();
    return offset ? std::optional<Duration>(*offset - _monotonicToSource) : std::nullopt;
}

std::optional<PeerClock::Duration> PeerClock::SentAt(Duration peerMonotonic) const
{
    const std::optional<Duration> offset = MonotonicToLocal();
    return offset ? std::optional<Duration>(*offset + peerMonotonic) : std::nullopt;
}

}  // namespace Rabit
