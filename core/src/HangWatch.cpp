#include "HangWatch.h"

#include <rabit/RabitLog.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace Rabit
{
namespace
{

std::string SecondsOfHang(std::chrono::nanoseconds time)
{
    char seconds[40];
    std::snprintf(seconds, sizeof seconds, "%.1f s", std::chrono::duration<double>(time).count());
    return seconds;
}

}  // namespace

HangWatch::HangWatch(std::size_t managers, std::chrono::nanoseconds patience)
    : _patience(patience), _watched(managers)
{
}

void HangWatch::Look(std::size_t manager, const std::string &name, bool toldToShutDown, const char *step,
                     std::chrono::nanoseconds hangsFor, Clock::time_point now)
{
    Watched &watched = _watched[manager];
    if (!toldToShutDown)
    {
        watched.Told = false;
        LookAtHang(watched, name, step, hangsFor);
        return;
    }
    if (!watched.Told)
    {
        watched = Watched{true, now, _patience};
    }
    const std::chrono::nanoseconds waited = now - watched.Since;
    if (waited < watched.NextReport)
    {
        return;
    }
    watched.NextReport = 2 * waited;
    RabitLog::Write(RabitLogLevel::Warning, "the reactor waits for manager \"" + name +
                                                "\", which was told to shut down " + SecondsOfHang(waited) +
                                                " ago and is still in " +
                                                (step != nullptr ? step : "its loop"));
}

void HangWatch::LookAtHang(Watched &watched, const std::string &name, const char *step,
                           std::chrono::nanoseconds hangsFor) const
{
    if (hangsFor == std::chrono::nanoseconds::zero())
    {
        watched.NextHang = _patience;
        watched.Hangs = false;
        return;
    }
    if (!std::exchange(watched.Hangs, true) || hangsFor < std::max(_patience, watched.NextHang))
    {
        return;
    }
    watched.NextHang = 2 * hangsFor;
    RabitLog::Write(RabitLogLevel::Warning, "manager \"" + name + "\" has been in " +
                                                (step != nullptr ? step : "its loop") + " for " +
                                                SecondsOfHang(hangsFor) +
                                                ": its wake-ups, its queue and a shutdown wait for it");
}

}  // namespace Rabit
