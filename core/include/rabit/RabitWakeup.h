#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace Rabit
{

// Where a manager sleeps and how it is woken. Shared between the manager and the handlers that wake it, so
// that an event that races with the end of the manager finds something to signal.
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
    // The same, and says that a control message was posted.
    void SignalControlChange();
    // Whether one was posted since this was asked last; true at first.
    bool TakeControlChange() { return _controlChanged.exchange(false, std::memory_order_acq_rel); }
    // Ends the sleep, and every later one until Reset.
    void RequestShutdown();
    bool IsShutdownRequested() const { return _shutdownRequested.load(std::memory_order_acquire); }
    // Zero: do not sleep. A sleep that is under way follows the new delay at once.
    void SetDelay(std::chrono::nanoseconds delay);
    std::chrono::nanoseconds GetDelay() const;

    // For the manager alone.
    //
    // Blocks for the delay, or until a signal or a shutdown request; then forgets the signals. For the first
    // `pause` of it only a shutdown request counts. Returns whether it slept: false if there was no need to.
    // Reads no clock after a signal, which is on its way to a unit of work.
    bool Sleep(std::chrono::nanoseconds pause);
    // The same sleep for a manager that is stepped: it sleeps between these two calls.
    void BeginSleep();
    void EndSleep();
    bool IsSignalled() const;
    void ForgetSignals();
    Counts TakeCounts();
    // Forgets signals and the shutdown request.
    void Reset();

private:
    void NotifyIfWaiting(std::unique_lock<std::mutex> &lock);

    mutable std::mutex _mutex;
    std::condition_variable _changed;
    bool _signalled = false;
    bool _asleep = false;
    bool _waiting = false;
    Counts _counts;
    std::chrono::nanoseconds _delay = std::chrono::seconds(1);
    std::atomic<bool> _shutdownRequested{false};
    std::atomic<bool> _controlChanged{true};
};

}  // namespace Rabit
