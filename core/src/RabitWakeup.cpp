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

// Notifies after the lock is released, so that the woken thread does not block on it.
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

// Notifies even if already signalled: earlier signals do not wake a manager that sleeps until its next
// turn.
void RabitWakeup::SignalControlChange()
{
    _controlChanged.store(true, std::memory_order_release);
    std::unique_lock<std::mutex> lock(_mutex);
    Count(_asleep ? _counts.WhileAsleep : _counts.WhileAwake);
    _signalled = true;
    NotifyIfWaiting(lock);
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

void RabitWakeup::SetPeriod(std::chrono::nanoseconds period)
{
    std::unique_lock<std::mutex> lock(_mutex);
    _period.Set(period);
    NotifyIfWaiting(lock);
}

std::chrono::nanoseconds RabitWakeup::GetPeriod() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _period.Get();
}

void RabitWakeup::SetSignalsBetweenTurns(bool count)
{
    std::unique_lock<std::mutex> lock(_mutex);
    _signalsBetweenTurns = count;
    NotifyIfWaiting(lock);
}

std::uint64_t RabitWakeup::MissedTurns() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _period.Missed();
}

bool RabitWakeup::MaySleep() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _period.IsSet() || _delay > std::chrono::nanoseconds::zero();
}

void RabitWakeup::BeginTurns(std::chrono::nanoseconds start)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_period.IsSet())
    {
        _period.Begin(start);
    }
    _isTurn = true;
    _isWorkDue = true;
}

std::chrono::nanoseconds RabitWakeup::SteadyNow()
{
    return std::chrono::steady_clock::now().time_since_epoch();
}

bool RabitWakeup::EndsAtOnce() const
{
    return OnlyTurnsCount() ? _controlChanged.load(std::memory_order_relaxed) : _signalled;
}

std::chrono::nanoseconds RabitWakeup::EndOf(std::chrono::nanoseconds start) const
{
    return _period.IsSet() ? _period.Next(start) : start + _delay;
}

void RabitWakeup::TakeTurn(std::chrono::nanoseconds start, std::chrono::nanoseconds now)
{
    _isTurn = !_period.IsSet() || _period.Take(start, now);
    _isWorkDue = _isTurn || !OnlyTurnsCount();
}

bool RabitWakeup::Sleep(std::chrono::nanoseconds pause)
{
    using Clock = std::chrono::steady_clock;
    std::unique_lock<std::mutex> lock(_mutex);
    const auto shutdown = [this] { return _shutdownRequested.load(std::memory_order_relaxed); };
    const bool mustPause = pause > std::chrono::nanoseconds::zero();
    const bool noSleep = !_period.IsSet() && (_signalled || _delay == std::chrono::nanoseconds::zero());
    if (shutdown() || (!mustPause && noSleep))
    {
        _signalled = false;
        _isTurn = true;
        _isWorkDue = true;
        return false;
    }
    const std::chrono::nanoseconds start = SteadyNow();
    bool slept = mustPause || !_period.IsSet();
    _asleep = true;
    _waiting = true;
    if (mustPause)
    {
        _changed.wait_until(lock, Clock::time_point(start + pause), shutdown);
    }
    // The end is computed anew after each wait, as the delay or the period may have been changed.
    while (!EndsAtOnce() && !shutdown())
    {
        const std::chrono::nanoseconds end = EndOf(start);
        if (SteadyNow() >= end)
        {
            break;
        }
        slept = true;
        _changed.wait_until(lock, Clock::time_point(end));
    }
    _waiting = false;
    _asleep = false;
    _signalled = false;
    TakeTurn(start, _period.IsSet() ? SteadyNow() : start);
    return slept;
}

void RabitWakeup::BeginSleep()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _asleep = true;
}

std::chrono::nanoseconds RabitWakeup::SleepUntil(std::chrono::nanoseconds start) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return EndsAtOnce() ? start : std::max(start, EndOf(start));
}

void RabitWakeup::EndSleep(std::chrono::nanoseconds start, std::chrono::nanoseconds now)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _asleep = false;
    _signalled = false;
    TakeTurn(start, now);
}

void RabitWakeup::SetTurn(bool isTurn)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _isTurn = isTurn;
    _isWorkDue = true;
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
