#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace Rabit
{

// Estimates when, on this node's monotonic clock, something happened that another node stamped with its
// source clock (SourceClock). The only input is that node's beats. No wall clock is used, so wall clocks may
// be wrong or be set at any time.
//
// A beat carries the sender's source clock, which runs as its monotonic one does, and its wall clock, read
// together. The smallest difference between arrival here and the sender's source clock belongs to the beat
// that was least delayed. This is the minimum filter of NTP (RFC 5905, section 10). A round trip less that
// difference gives the same for the way there, from us to the peer; a second filter keeps its minimum. The
// delay of the quickest beat is taken to be half of the sum of both minima, because the two directions cannot
// be told apart. The queue may have been full during the few measured round trips. That makes nothing look
// older than it is, unless the queue was full on the way there. Both filters forget after 15 to 30 seconds,
// so that drift does not add up.
//
// A clock may have stood still: a virtual machine was paused, or a computer suspended. That makes all later
// differences larger, as a delay of every beat would. The echo that a beat carries tells the two apart: the
// beat cannot have been on its way for longer than the round trip that it ends. If the estimate says that it
// was, by more than 100 ms, the estimate is wrong, and the filter begins anew with that beat. One beat is
// proof: a delay, however long, constant or slowly varying, lengthens the round trip as much. Two standstills
// pass unnoticed until the filter forgets: one no longer than the round trip, and one of a peer that does not
// hear us, because its beats carry no echo of ours.
//
// ToLocal maps a stamp from before the standstill to its true time. It takes a stamp from between the peer's
// return and the proof, or from between two standstills, for one from before: it errs towards older. Not
// thread-safe; has no clock of its own.
class PeerClock
{
public:
    using Duration = std::chrono::nanoseconds;

    // The clocks of the sender, read at one moment, as a beat carries them.
    struct Reading
    {
        Duration Source{0};
        Duration Wall{0};  // since 1970
    };

    // Adds a beat, and when it arrived here (monotonic).
    void OnBeat(const Reading &peer, Duration arrival);
    // Adds the round trip that ended with the last beat, at `now`. Negative ones (a garbled echo) are
    // ignored.
    void OnRoundTrip(Duration roundTrip, Duration now);

    // The last round trip; empty before the first.
    std::optional<Duration> RoundTrip() const { return _lastRoundTrip; }
    // How the peer's source clock relates to this node's monotonic clock.
    struct SourceRelation
    {
        Duration ToLocal{0};          // to be added to a source time
        Duration StoodStill{0};       // how long the peer's clock stood still in all
        Duration StoodStillUntil{0};  // source times before this lack `StoodStill`

        // Converts a source time to this node's monotonic clock.
        Duration At(Duration source) const
        {
            return source + ToLocal - (source < StoodStillUntil ? StoodStill : Duration(0));
        }
    };
    // Empty before the first beat.
    std::optional<SourceRelation> Source() const;
    // Converts a source time to this node's monotonic clock; empty before the first beat.
    std::optional<Duration> ToLocal(Duration source) const;
    // The difference to add to the peer's source clock to get its wall clock, as of the last beat.
    Duration SourceToWall() const { return _sourceToWall; }
    // When a beat with that source time was sent, by this node's monotonic clock; empty before the first
    // beat.
    std::optional<Duration> SentAt(Duration source) const;
    // True if the last beat came more than 100 ms earlier than any that the filter knew. This node's own
    // clock then seems to have stood still. If it has, the peer takes this node's beats for old ones until
    // one of them echoes a beat that the peer has sent since. A queue on the way that has emptied looks the
    // same.
    bool StoodStillHere() const { return _stoodStillHere; }
    // How much later the last beat came than the quickest that the filter knows.
    Duration LastDelay() const { return _lastDifference - _difference.Value().value_or(_lastDifference); }

private:
    // The minimum over the last one to two periods.
    class MinimumFilter
    {
    public:
        void Add(Duration value, Duration now);
        // Forgets all but this value.
        void Restart(Duration value, Duration now);
        std::optional<Duration> Value() const;

    private:
        std::optional<Duration> _current;
        std::optional<Duration> _previous;
        Duration _periodStart{0};
    };

    void Estimate();
    Duration QuickestDelay() const;

    MinimumFilter _difference;
    MinimumFilter
        _wayThere;  // the same of our beats, arrival there less our clock: a round trip less a difference
    MinimumFilter _roundTrip;
    Duration _lastDifference{0};
    Duration _lastSource{0};
    bool _stoodStillHere = false;
    Duration _stoodStill{0};
    Duration _stoodStillUntil{0};
    Duration _sourceToWall{0};
    std::optional<Duration> _lastRoundTrip;
    std::optional<Duration> _toLocal;  // to be added to a source time; kept because every sample needs it
};

}  // namespace Rabit
