#include <rabit/RabitWakeup.h>

#include <algorithm>
#include <limits>

namespace Rabit
{
namespace
{

void Count(int &counter)
{
    if (counter < std::numeric_limits<int>::max())
    {
        ++counter;
    }
}

}  // namespace

// Notifies after the lock is given back, so that the woken thread does not run into it.
void RabitWakeup::NotifyIfWaiting(std::unique_lock<std::mutex> &lock)
{
    const bool waiting = _waiting;
    lock.unlock();
    if (waiting)
    {
        _changed.notify_one();
    }
}

void RabitWakeup::Signal()
{
    std::unique_lock<std::mutex> lock(_mutex);
    Count(_asleep ? _counts.WhileAsleep : _counts.WhileAwake);
    if (!_signalled)
    {
        _signalled = true;
        NotifyIfWaiting(lock);
    }
}

void RabitWakeup::SignalControlChange()
{
    _controlChanged.store(true, std::memory_order_release);
    Signal();
}

void RabitWakeup::RequestShutdown()
{
    std::unique_lock<std::mutex> lock(_mutex);
    _shutdownRequested.store(true, std::memory_order_release);
    NotifyIfWaiting(lock);
}

void RabitWakeup::SetDelay(std::chrono::nanoseconds delay)
{
    std::unique_lock<std::mutex> lock(_mutex);
    _delay = std::max(delay, std::chrono::nanoseconds::zero());
    NotifyIfWaiting(lock);
}

std::chrono::nanoseconds RabitWakeup::GetDelay() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _delay;
}

bool RabitWakeup::Sleep(std::chrono::nanoseconds pause)
{
    using Clock = std::chrono::steady_clock;
    std::unique_lock<std::mutex> lock(_mutex);
    const auto shutdown = [this] { return _shutdownRequested.load(std::memory_order_relaxed); };
    const bool mustPause = pause > std::chrono::nanoseconds::zero();
    if (shutdown() || (!mustPause && (_signalled || _delay == std::chrono::nanoseconds::zero())))
    {
        _signalled = false;
        return false;
    }
    const Clock::time_point start = Clock::now();
    _asleep = true;
    _waiting = true;
    if (mustPause)
    {
        _changed.wait_until(lock, start + pause, shutdown);
    }
    // The deadline is computed anew after each wait, as the delay may have been changed.
    while (!_signalled && !shutdown())
    {
        const Clock::time_point deadline = start + _delay;
        if (Clock::now() >= deadline)
        {
            break;
        }
        _changed.wait_until(lock, deadline);
    }
    _waiting = false;
    _asleep = false;
    _signalled = false;
    return true;
}

void RabitWakeup::BeginSleep()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _asleep = true;
}

void RabitWakeup::EndSleep()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _asleep = false;
    _signalled = false;
}

bool RabitWakeup::IsSignalled() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _signalled;
}

void RabitWakeup::ForgetSignals()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _signalled = false;
}

RabitWakeup::Counts RabitWakeup::TakeCounts()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const Counts counts = _counts;
    _counts = Counts();
    return counts;
}

void RabitWakeup::Reset()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _signalled = false;
    _asleep = false;
    _shutdownRequested.store(false, std::memory_order_release);
}

}  // namespace Rabit
