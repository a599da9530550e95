#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace Rabit
{

// Estimates when, on this node's monotonic clock, something happened that another node stamped with its own
// wall clock, from that node's beats alone: neither wall clock is trusted to be right, and a step of either
// is noticed with the next beat.
//
// A beat carries the sender's monotonic and wall clock read together. The smallest difference between arrival
// here and the sender's monotonic clock belongs to the beat that was least delayed (the minimum filter of
// NTP, RFC 5905, section 10); half the smallest round trip is taken as its delay. The filter forgets after 15
// to 30 seconds, so that drift does not add up. Not thread-safe; no clock of its own.
class PeerClock
{
public:
    using Duration = std::chrono::nanoseconds;

    // A beat: the sender's clocks as written in it, and when it arrived here (monotonic).
    void OnBeat(Duration peerMonotonic, Duration peerWall, Duration arrival);
    // A round trip measured at that moment; negative ones (a garbled echo) are ignored.
    void OnRoundTrip(Duration roundTrip, Duration now);

    // The last round trip; empty while there was none.
    std::optional<Duration> RoundTrip() const { return _lastRoundTrip; }
    // What to add to the peer's wall clock to get this node's monotonic clock; empty before the first beat.
    std::optional<Duration> WallToLocal() const;
    // When a beat with that monotonic reading was sent, by this node's monotonic clock; empty before the
    // first beat.
    std::optional<Duration> SentAt(Duration peerMonotonic) const;

private:
    // The minimum over the last one to two periods.
    class MinimumFilter
    {
    public:
        void Add(Duration value, Duration now);
        std::optional<Duration> Value() const;

    private:
        std::optional<Duration> _current;
        std::optional<Duration> _previous;
        Duration _periodStart{0};
    };

    std::optional<Duration> MonotonicToLocal() const;

    MinimumFilter _difference;
    MinimumFilter _roundTrip;
    Duration _wallMinusMonotonic{0};
    std::optional<Duration> _lastRoundTrip;
};

}  // namespace Rabit
