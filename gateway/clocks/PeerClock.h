#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace Rabit
{

// Estimates when, on this node's monotonic clock, something happened that another node stamped with its
// source clock (SourceClock), from that node's beats alone. No wall clock is used, so that none need be right
// or keep from being set.
//
// A beat carries the sender's monotonic and wall clock read together. The smallest difference between arrival
// here and the sender's monotonic clock belongs to the beat that was least delayed (the minimum filter of
// NTP, RFC 5905, section 10); half the smallest round trip is taken as its delay. The filter forgets after 15
// to 30 seconds, so that drift does not add up. Not thread-safe; no clock of its own.
class PeerClock
{
public:
    using Duration = std::chrono::nanoseconds;

    // The clocks of the sender, read at one moment, as written in a beat.
    struct Reading
    {
        Duration Monotonic{0};
        Duration Source{0};
        Duration Wall{0};  // since 1970
    };

    // A beat, and when it arrived here (monotonic).
    void OnBeat(const Reading &peer, Duration arrival);
    // A round trip measured at that moment; negative ones (a garbled echo) are ignored.
    void OnRoundTrip(Duration roundTrip, Duration now);

    // The last round trip; empty while there was none.
    std::optional<Duration> RoundTrip() const { return _lastRoundTrip; }
    // What to add to the peer's source clock to get this node's monotonic clock; empty before the first beat.
    std::optional<Duration> SourceToLocal() const;
    // What to add to the peer's source clock to get its wall clock, as of the last beat.
    Duration SourceToWall() const { return _sourceToWall; }
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
    Duration _monotonicToSource{0};
    Duration _sourceToWall{0};
    std::optional<Duration> _lastRoundTrip;
};

}  // namespace Rabit
