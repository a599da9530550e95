#pragma once

#include <rabit/RabitManager.h>
#include <rabit/RabitPeriod.h>

#include <algorithm>
#include <chrono>
#include <initializer_list>

namespace Rabit
{

// One of several timers of a manager, which may also be woken between their turns. A manager with one steady
// rate needs none: it has SetPeriodSec, SetWakeupBetweenTurns and IsTurn.
//
//     void ExecuteUnitOfWork() final
//     {
//         TakeMessages();  // at once when one comes
//         if (_report.IsDue(*this))
//             Report();
//         if (_look.IsDue(*this))
//             Look();
//         Rabit::RabitTimer::SleepUntilDue(*this, {&_report, &_look});
//     }
//     Rabit::RabitTimer _report{std::chrono::seconds(1)};
//     Rabit::RabitTimer _look{std::chrono::milliseconds(200)};
//
// The first call of IsDue is the first turn. Turns lie exactly a period apart, however late one is taken.
// Turns that passed meanwhile are skipped. Not thread-safe: for the manager's unit of work.
class RabitTimer
{
public:
    using Duration = std::chrono::nanoseconds;

    // A period of 0 or less is always due.
    explicit RabitTimer(Duration period) { _period.Set(period); }

    // True if a turn has come, which is then taken. `now` is of any clock that does not go back.
    bool IsDue(Duration now)
    {
        if (_began && _period.IsSet())
        {
            return _period.Take(now, now);
        }
        _began = true;
        _period.Begin(now);
        return true;
    }
    // The same by the clock of the manager's workspace.
    bool IsDue(const RabitManager &manager) { return IsDue(Now(manager)); }
    // The time until the next turn; 0 if it has come.
    Duration UntilDue(Duration now) const
    {
        return _began ? std::max(_period.Next(now) - now, Duration::zero()) : Duration::zero();
    }
    Duration UntilDue(const RabitManager &manager) const { return UntilDue(Now(manager)); }

    // Calls SetWakeupTimeDelaySec with the time until the first turn of these timers. Until then the manager
    // sleeps, unless something wakes it. Call it last in each unit of work. The manager has no period then.
    //
    // Each unit of work asks IsDue of each of these timers. One that is not asked stays due, and the manager
    // runs without a pause until it is.
    static void SleepUntilDue(RabitManager &manager, std::initializer_list<const RabitTimer *> timers)
    {
        const Duration now = Now(manager);
        Duration first = Duration::max();
        for (const RabitTimer *timer : timers)
        {
            first = std::min(first, timer->UntilDue(now));
        }
        // Never 0: that is the delay of a manager that waits for input itself.
        first = std::max(first, Duration(1));
        manager.SetWakeupTimeDelaySec(std::chrono::duration<double>(first).count());
    }

private:
    static Duration Now(const RabitManager &manager) { return manager.GetWorkspace().GetClock().Monotonic(); }

    RabitPeriod _period;
    bool _began = false;
};

}  // namespace Rabit
