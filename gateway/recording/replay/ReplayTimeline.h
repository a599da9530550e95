#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "recording/replay/ReplayItem.h"

namespace Rabit::Replay
{

// Tells which message of a recording is due when. `now` is any clock of the caller that never goes back,
// not the recording's. After a jump (the beginning, a seek, a new round) the last message before it of each
// stream comes first. So all is there that was known then. Not thread-safe.
class ReplayTimeline
{
public:
    using Duration = std::chrono::nanoseconds;

    struct Settings
    {
        Time From = 0;
        Time To = 0;  // included
        // Recorded seconds in one second; 0: as fast as messages are taken.
        double Rate = 1.0;
        bool Loops = false;
        bool Paused = false;
    };
    // Shortest duration of a round of a looping replay, in nanoseconds.
    static constexpr Time ShortestRound = 1'000'000'000;

    struct Due
    {
        ReplayItem Item;
        Duration Age{0};  // that it had then: when it was recorded, or where the replay has jumped to
        bool IsRestored = false;
    };

    // The source must outlive it. Jumps to the beginning.
    ReplayTimeline(ReplaySource &source, const Settings &settings, Duration now);

    // Returns one message that is due now; nothing if none is.
    std::optional<Due> Next(Duration now);
    // Returns when to call Next again; nothing: not before one of the calls below.
    std::optional<Duration> DueAt(Duration now) const;

    void Pause(Duration now);
    void Resume(Duration now);
    bool IsPaused() const { return _paused; }
    // Pauses, and makes the next message due.
    void Step(Duration now);
    // Goes on from `to`, which is clamped to From and To.
    void Seek(Time to, Duration now);

    // The present moment of the recording.
    Time Position(Duration now) const;
    // True if no message comes any more, unless Seek is called.
    bool IsAtEnd(Duration now) const;
    // Number of jumps, the first one included. The messages before a jump no longer hold.
    std::uint64_t Jumps() const { return _jumps; }
    Time JumpedTo() const { return _jumpedTo; }
    std::uint64_t Rounds() const { return _rounds; }

private:
    void Jump(Time to, Duration now);
    void TakeNext();
    bool IsTurnOf(Time time, Duration now) const;
    Duration When(Time time) const;
    bool IsRoundOver(Duration now) const;

    ReplaySource &_source;
    const Settings _settings;
    const Time _roundEnd;
    bool _paused;
    std::uint64_t _steps = 0;  // that are owed
    std::deque<ReplayItem> _restored;
    std::optional<ReplayItem> _next;  // up to To
    bool _anyInRound = false;
    // The replay was at _anchor when the clock showed _anchorNow.
    Time _anchor = 0;
    Duration _anchorNow{0};
    Time _jumpedTo = 0;
    std::uint64_t _jumps = 0;
    std::uint64_t _rounds = 1;
};

}  // namespace Rabit::Replay
