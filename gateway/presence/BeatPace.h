#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace Rabit
{

// When this node beats: once a period, quickly when somebody has come who must not wait for the next period,
// and earlier when there is something to ask for, or a State was written that may be lost. Beats that were
// brought forward follow each other less and less quickly, until nobody has brought one forward for a while:
// who asks without end does not make this node shout.
//
// A pure state machine; `now` never goes back.
class BeatPace
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration DefaultPeriod = std::chrono::milliseconds(500);
    static constexpr Duration ShortestPeriod = std::chrono::milliseconds(100);
    static constexpr Duration LongestPeriod = std::chrono::seconds(60);
    // No two beats follow each other more quickly.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(50);
    // The first beats that are brought forward follow each other after so long at the latest: a question or
    // its answer may be lost.
    static constexpr Duration QuickGap = std::chrono::milliseconds(300);
    static constexpr int QuickBeats = 12;
    // After so long without one the next may be brought forward as if it were the first.
    static constexpr Duration Quiet = std::chrono::seconds(5);
    // After so long without a newcomer the next one is met with beats that are twice as quick.
    static constexpr Duration SeriesRest = std::chrono::seconds(1);
    // Who lacks a State learns of it from the beat after it. So that comes so long after the last of several
    // States in a row (those of 10 Hz need none of their own), but for States alone no sooner than that after
    // another beat, and with a period longer than the usual one not before its time.
    static constexpr Duration AfterState = std::chrono::milliseconds(120);
    static constexpr Duration GapForStates = std::chrono::milliseconds(200);

    Duration Period() const { return _period; }
    // Beats that are brought forward follow each other after so long at the latest, if that is less than a
    // period: for who beats seldom and wants answers. A ShortestGap at least.
    void SetLongestGap(Duration gap) { _longestGap = std::max(gap, ShortestGap); }
    // Raised or lowered to what is possible. A longer one holds from the next beat on, which is the first to
    // tell the others of it.
    void SetPeriod(Duration period);

    // When the next beat is due if nobody has anything to ask.
    Duration Due() const { return _stateDue ? std::min(_due, *_stateDue) : _due; }
    // What the last one has told the others: one comes by then, whatever there is to say.
    Duration Promised() const { return _promised; }
    // Before this there is none at all.
    Duration Earliest() const { return _last ? *_last + ShortestGap : Duration(0); }
    // Before this none is brought forward because there is something to ask for.
    Duration EarliestToAsk() const { return _last ? *_last + _gap : Duration(0); }

    // Somebody has come: the next beats follow each other quickly, each step twice the one before. Who comes
    // soon after another has half as quick ones, and of a whole fleet that comes one after another the last
    // ones hear the usual ones: on a thin radio, that they come over seconds shows that it is full.
    void Introduce(Duration now);
    // A State was written.
    void StateWritten(Duration now);
    // A beat was sent. `delay` is how long datagrams wait in queues now: a question is not asked again before
    // its answer can have come.
    void Sent(Duration now, Duration delay = Duration(0));
    // A beat was sent before it was due, because it would have been late otherwise. Nobody has brought it
    // forward.
    void SentEarly(Duration now);

private:
    void CalmDown(Duration now);
    void Begin(Duration now);

    Duration _period = DefaultPeriod;
    Duration _due{0};
    Duration _promised{0};
    Duration _step = Duration::max();  // to the beat after the next one; more than the period: the period
    Duration _gap = ShortestGap;
    Duration _longestGap = LongestPeriod;
    int _quick = 0;                  // beats that were brought forward since the gap was shortest
    Duration _series = ShortestGap;  // first step of the last introduction
    std::optional<Duration> _introduced;
    std::optional<Duration> _last;
    std::optional<Duration> _broughtForward;
    std::optional<Duration> _stateDue;
};

}  // namespace Rabit
