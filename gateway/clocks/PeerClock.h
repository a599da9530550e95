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
// A beat carries the sender's source clock, which runs as its monotonic one does, and its wall clock, read
// together. The smallest difference between arrival here and the sender's source clock belongs to the beat
// that was least delayed (the minimum filter of NTP, RFC 5905, section 10). What of a round trip that beat's
// difference does not account for is the way there: its minimum is known as well, of whichever beat of ours.
// Half of the two together is taken as the delay of the quickest beat; nobody can tell one way from the
// other. A queue that was full while the few round trips were measured makes nothing look older than it is,
// unless it was full on the way there. Both filters forget after 15 to 30 seconds, so that drift does not add
// up.
//
// A clock that stood still (a virtual machine that was paused, a computer that was suspended) makes all later
// differences larger, as a delay of every beat would. The two are told apart by the echo that a beat carries:
// it cannot have been on its way for longer than the round trip that it ends. If the estimate says that it
// was, by more than a tenth of a second, the estimate is wrong, and the filter begins anew with that beat.
// One beat is proof: a delay, however long, constant or slowly varying, lengthens the round trip as much. The
// limits: a standstill no longer than the round trip passes unnoticed until the filter forgets, and so does
// one of a peer that does not hear us, for its beats carry no echo of ours.
//
// What the peer stamped before it stood still is as old as it was: ToLocal knows. Of what it stamped between
// its return and the proof it believes the same, and so of two standstills the first: it errs towards older.
// Not thread-safe; no clock of its own.
class PeerClock
{
public:
    using Duration = std::chrono::nanoseconds;

    // The clocks of the sender, read at one moment, as said by a beat.
    struct Reading
    {
        Duration Source{0};
        Duration Wall{0};  // since 1970
    };

    // A beat, and when it arrived here (monotonic).
    void OnBeat(const Reading &peer, Duration arrival);
    // A round trip that ended with the last beat, at that moment; negative ones (a garbled echo) are ignored.
    void OnRoundTrip(Duration roundTrip, Duration now);

    // The last round trip; empty while there was none.
    std::optional<Duration> RoundTrip() const { return _lastRoundTrip; }
    // How the peer's source clock relates to this node's monotonic clock.
    struct SourceRelation
    {
        Duration ToLocal{0};          // to be added to a source time
        Duration StoodStill{0};       // how long the peer's clock stood still in all
        Duration StoodStillUntil{0};  // source times before this lack that

        // A source time by this node's monotonic clock.
        Duration At(Duration source) const
        {
            return source + ToLocal - (source < StoodStillUntil ? StoodStill : Duration(0));
        }
    };
    // Empty before the first beat.
    std::optional<SourceRelation> Source() const;
    // A source time, by this node's monotonic clock; empty before the first beat.
    std::optional<Duration> ToLocal(Duration source) const;
    // What to add to the peer's source clock to get its wall clock, as of the last beat.
    Duration SourceToWall() const { return _sourceToWall; }
    // When a beat with that source time was sent, by this node's monotonic clock; empty before the first
    // beat.
    std::optional<Duration> SentAt(Duration source) const;
    // Whether the last beat came so much earlier than all that the filter knew that this node's own clock
    // seems to have stood still. If it has, the peer takes this node's beats for old ones until one echoes a
    // beat that the peer has sent since. A queue on the way that has emptied looks alike.
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
    std::optional<Duration> _toLocal;  // to be added to a source time: asked for with each sample
};

}  // namespace Rabit
