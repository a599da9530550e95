#pragma once

#include <chrono>
#include <ctime>

namespace Rabit
{

// The monotonic clock behind all times and ages in Rabit: the time since this computer was started. Unlike
// std::chrono::steady_clock it goes on while the computer is suspended, so that the time of the suspension
// counts in the age of messages. Not for waiting: timed waits of the standard library do not count it.
struct UptimeClock
{
    using duration = std::chrono::nanoseconds;
    using rep = duration::rep;
    using period = duration::period;
    using time_point = std::chrono::time_point<UptimeClock>;
    static constexpr bool is_steady = true;

    static time_point now() noexcept { return ToTimePoint(Read()); }
    // The same, as the system gives it.
    static std::timespec Read() noexcept
    {
        std::timespec time{};
        clock_gettime(CLOCK_BOOTTIME, &time);
        return time;
    }
    static time_point ToTimePoint(const std::timespec &time) noexcept
    {
        return time_point(std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
    }
};

}  // namespace Rabit
