#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace Rabit
{

// Decides when this node beats: once a period, quickly for a newcomer, and earlier for a question or after a
// State was written, which may be lost. Beats that were brought forward follow each other less and less
// quickly, until none was brought forward for a while. So endless questions do not make this node flood the
// channel.
//
// A pure state machine; `now` never goes back.
class BeatPace
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration DefaultPeriod = std::chrono::milliseconds(500);
    static constexpr Duration ShortestPeriod = std::chrono::milliseconds(100);
    static constexpr Duration LongestPeriod = std::chrono::seconds(60);
    // Least time between two beats.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(50);
    // Longest time between the first QuickBeats beats that are brought forward: a question or its answer may
    // be lost.
    static constexpr Duration QuickGap = std::chrono::milliseconds(150);
    static constexpr int QuickBeats = 20;
    // After this time without a beat that was wanted, the next one brought forward counts as the first.
    static constexpr Duration Quiet = std::chrono::seconds(5);
    // Each such time without a newcomer makes the beats for the next one twice as quick.
    static constexpr Duration SeriesRest = std::chrono::seconds(1);
    // A node that lost a State learns of it from the next beat. That beat comes AfterState after the last of
    // several States in a row (States at 10 Hz need no beat of their own). For States alone it comes no
    // sooner than GapForStates after another beat, and not before its time if the period is longer than
    // DefaultPeriod.
    static constexpr Duration AfterState = std::chrono::milliseconds(120);
    static constexpr Duration GapForStates = std::chrono::milliseconds(200);

    Duration Period() const { return _period; }
    // Sets the longest time between beats that are brought forward, if that is less than a period: for a node
    // that beats seldom and wants answers. Raised to ShortestGap.
    void SetLongestGap(Duration gap) { _longestGap = std::max(gap, ShortestGap); }
    // Sets the period, clamped to the range above. A longer period holds from the next beat on, the first
    // beat that tells the others of it.
    void SetPeriod(Duration period);

    // When the next beat is due if there is no question.
    Duration Due() const { return _stateDue ? std::min(_due, *_stateDue) : _due; }
    // The time by which the last beat promised the next one.
    Duration Promised() const { return _promised; }
    // No beat comes before this time.
    Duration Earliest() const { return _last ? *_last + ShortestGap : Duration(0); }
    // No beat is brought forward for a question to a time before this.
    Duration EarliestToAsk() const { return _last ? *_last + _gap : Duration(0); }

    // A node has come: the next beats follow each other quickly, each step twice the one before. The beats
    // for a newcomer soon after another are half as quick, so the last of a whole fleet get the usual beats:
    // on a thin radio newcomers spread over seconds show that it is full.
    void Introduce(Duration now);
    // A State was written.
    void StateWritten(Duration now);
    // A beat was sent. `delay` is how long datagrams wait in queues now: a question is not asked again before
    // its answer can have come. `isWanted`: a question or news waited for it. Then it is no sign of quiet,
    // even if it was not brought forward.
    void Sent(Duration now, Duration delay = Duration(0), bool isWanted = false);
    // A beat was sent before it was due, because it would have been late otherwise. It does not count as
    // brought forward.
    void SentEarly(Duration now);

private:
    void CalmDown(Duration now);
    void Begin(Duration now);

    Duration _period = DefaultPeriod;
    Duration _due{0};
    Duration _promised{0};
    Duration _step = Duration::max();  // to the beat after the next one; more than the period: the period
    Duration _gap = ShortestGap;       // no Backoff: its limits change with the period and with `delay`
    Duration _longestGap = LongestPeriod;
    int _quick = 0;                  // beats that were brought forward since the gap was shortest
    Duration _series = ShortestGap;  // first step of the last introduction
    std::optional<Duration> _introduced;
    std::optional<Duration> _last;
    std::optional<Duration> _wanted;  // the last beat that was wanted
    std::optional<Duration> _stateDue;
};

}  // namespace Rabit
