#include "HangWatch.h"

#include <rabit/RabitLog.h>

#include <cstdio>

namespace Rabit
{

HangWatch::HangWatch(std::size_t managers, std::chrono::nanoseconds patience)
    : _patience(patience), _watched(managers)
{
}

void HangWatch::Look(std::size_t manager, const std::string &name, bool toldToShutDown, const char *step,
                     Clock::time_point now)
{
    Watched &watched = _watched[manager];
    if (!toldToShutDown)
    {
        watched.Told = false;
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
    char seconds[40];
    std::snprintf(seconds, sizeof seconds, "%.1f s", std::chrono::duration<double>(waited).count());
    RabitLog::Write(RabitLogLevel::Warning,
                    "the reactor waits for manager \"" + name + "\", which was told to shut down " + seconds +
                        " ago and is still in " + (step != nullptr ? step : "its loop"));
}

}  // namespace Rabit
