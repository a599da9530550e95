#pragma once

#include <rabit/RabitPeriod.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace Rabit
{

// Where a manager sleeps and how it is woken. Shared between the manager and the handlers that wake it. So an
// event that races with the end of the manager finds something to signal.
//
// Signals do not stack: all that come between two passes cause one pass.
class RabitWakeup
{
public:
    // How often Signal was called since the last TakeCounts.
    struct Counts
    {
        int WhileAsleep = 0;
        int WhileAwake = 0;
    };

    // From any thread.
    void Signal();
    // Signals that a control message was posted. This also ends a sleep until the next turn.
    void SignalControlChange();
    // True if a control message was posted since the last call; true at the first call.
    bool TakeControlChange() { return _controlChanged.exchange(false, std::memory_order_acq_rel); }
    // Ends the sleep, and every later one until Reset.
    void RequestShutdown();
    bool IsShutdownRequested() const { return _shutdownRequested.load(std::memory_order_acquire); }
    // Zero: do not sleep. A sleep that is under way follows the new delay at once.
    void SetDelay(std::chrono::nanoseconds delay);
    std::chrono::nanoseconds GetDelay() const;
    // In place of the delay; zero: none. A sleep that is under way follows the new period at once.
    void SetPeriod(std::chrono::nanoseconds period);
    std::chrono::nanoseconds GetPeriod() const;
    // Sets whether signals end a sleep until the next turn of the period (default: false).
    void SetSignalsBetweenTurns(bool count);
    // Number of turns that passed without a pass of their own, since construction.
    std::uint64_t MissedTurns() const;
    // True if the manager sleeps at all: false if the delay is zero and there is no period.
    bool MaySleep() const;

    // For the manager alone.
    //
    // The next turn of the period is one period after `start`, and the first pass is a turn.
    void BeginTurns(std::chrono::nanoseconds start);
    // Now, on the timeline that Sleep takes turns by: that of std::chrono::steady_clock.
    static std::chrono::nanoseconds SteadyNow();
    // Blocks until the next turn, or for the delay if there is no period, or until a signal or a shutdown
    // request; then forgets the signals. During the first `pause` only a shutdown request ends the sleep.
    // Returns whether it slept. Without a period no clock is read after a signal, as that would delay the
    // unit of work.
    bool Sleep(std::chrono::nanoseconds pause);
    // The same sleep for a stepped manager, which sleeps between BeginSleep and EndSleep. SleepUntil
    // returns when that sleep ends if nothing else ends it.
    void BeginSleep();
    std::chrono::nanoseconds SleepUntil(std::chrono::nanoseconds start) const;
    void EndSleep(std::chrono::nanoseconds start, std::chrono::nanoseconds now);
    // Sets the value of IsTurn for the next pass, and IsWorkDue to true, no matter what ended the sleep.
    void SetTurn(bool isTurn);
    bool IsSignalled() const;
    void ForgetSignals();
    Counts TakeCounts();
    // Forgets signals and the shutdown request.
    void Reset();
    // Why the last sleep ended. IsTurn: a turn has come (always true without a period). IsWorkDue: a unit
    // of work is due; false if only the control messages need a look.
    bool IsTurn() const { return _isTurn; }
    bool IsWorkDue() const { return _isWorkDue; }

private:
    void NotifyIfWaiting(std::unique_lock<std::mutex> &lock);
    bool OnlyTurnsCount() const { return _period.IsSet() && !_signalsBetweenTurns; }
    bool EndsAtOnce() const;
    std::chrono::nanoseconds EndOf(std::chrono::nanoseconds start) const;
    void TakeTurn(std::chrono::nanoseconds start, std::chrono::nanoseconds now);

    mutable std::mutex _mutex;
    std::condition_variable _changed;
    bool _signalled = false;
    bool _asleep = false;
    bool _waiting = false;
    Counts _counts;
    std::chrono::nanoseconds _delay = std::chrono::seconds(1);
    RabitPeriod _period;
    bool _signalsBetweenTurns = false;
    std::atomic<bool> _shutdownRequested{false};
    std::atomic<bool> _controlChanged{true};

    // Used by the manager's loop alone.
    bool _isTurn = true;
    bool _isWorkDue = true;
};

}  // namespace Rabit
