#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "recording/replay/ReplayItem.h"

namespace Rabit::Replay
{

// What of a recording is due when. `now` is any clock that never goes back; it is handed in, and is not the
// recording's. After a jump (the beginning, a seek, a new round) the last message before it of each stream
// comes first, so that nothing is missing which was known then. Not thread-safe.
class ReplayTimeline
{
public:
    using Duration = std::chrono::nanoseconds;

    struct Settings
    {
        Time From = 0;
        Time To = 0;  // included
        // Recorded seconds in one; 0: as fast as messages are taken.
        double Rate = 1.0;
        bool Loops = false;
        bool Paused = false;
    };
    // Of one that loops, however little there is in it.
    static constexpr Time ShortestRound = 1'000'000'000;

    struct Due
    {
        ReplayItem Item;
        Duration Age{0};  // that it had then: when it was recorded, or where the replay has jumped to
        bool IsRestored = false;
    };

    // The source must outlive it. Jumps to the beginning.
    ReplayTimeline(ReplaySource &source, const Settings &settings, Duration now);

    // What is due now, one at a time: nothing, if it is not its turn yet.
    std::optional<Due> Next(Duration now);
    // When to ask again; nothing: not before one of the calls below.
    std::optional<Duration> DueAt(Duration now) const;

    void Pause(Duration now);
    void Resume(Duration now);
    bool IsPaused() const { return _paused; }
    // Pauses, and has the next message come.
    void Step(Duration now);
    // Goes on from there; what is outside of From and To is taken as the nearer of them.
    void Seek(Time to, Duration now);

    // Where it is.
    Time Position(Duration now) const;
    // Nothing comes any more, unless it is told to seek.
    bool IsAtEnd(Duration now) const;
    // How often it has jumped, the first time included: what was there before a jump no longer holds.
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
    // The replay was there when the clock showed that.
    Time _anchor = 0;
    Duration _anchorNow{0};
    Time _jumpedTo = 0;
    std::uint64_t _jumps = 0;
    std::uint64_t _rounds = 1;
};

}  // namespace Rabit::Replay
