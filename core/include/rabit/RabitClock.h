#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

namespace Rabit
{

// The moment of a post, by both clocks of a node.
struct PostTime
{
    // GPS seconds since 1980-01-06: the time stamp that messages carry. Can step when the wall clock is set.
    double GpsTimeSeconds = 0.0;
    // The same moment by the monotonic clock of the workspace: what ages are computed from.
    std::chrono::nanoseconds Monotonic{0};
    // The time stamp in whole nanoseconds. GpsTimeSeconds is the nearest double, so times that differ here
    // may be equal there. Zero if only the double is known. Ignored if GpsTimeSeconds is not its double.
    std::chrono::nanoseconds GpsTime{0};
};

// A source of time. A RabitWorkspace has one, and everything in the workspace takes its time from it. A
// test or a simulation uses another one (ManualClock).
//
// All methods may be called from any thread at any time and do not throw.
class RabitClock
{
public:
    virtual ~RabitClock() = default;
    RabitClock(const RabitClock &) = delete;
    RabitClock &operator=(const RabitClock &) = delete;

    // Time since some fixed moment; never goes back. Unlike std::chrono::steady_clock, the system's also
    // counts the time for which the computer was suspended.
    virtual std::chrono::nanoseconds Monotonic() const = 0;
    // GPS seconds since 1980-01-06. Follows the wall clock: it may step in either direction.
    virtual double GpsTimeSeconds() const = 0;
    // Both clocks at the same moment. The system clock overrides it to read only one clock.
    virtual PostTime Now() const { return PostTime{GpsTimeSeconds(), Monotonic()}; }

    // The clocks of this computer: UptimeClock, and SystemTimeClock for GPS seconds.
    static const std::shared_ptr<RabitClock> &System();

    // The double nearest to a GPS time; a later time never gives a smaller double. Today's GPS seconds are so
    // large that their doubles are 238 ns apart.
    static double ToSeconds(std::chrono::nanoseconds gpsTime)
    {
        constexpr std::int64_t second = 1'000'000'000;
        return ToSeconds(gpsTime.count() / second, gpsTime.count() % second);
    }
    // The same of whole seconds and further nanoseconds: a double cannot hold the nanoseconds since 1980.
    static double ToSeconds(std::int64_t seconds, std::int64_t nanoseconds)
    {
        return static_cast<double>(seconds) + static_cast<double>(nanoseconds) * 1e-9;
    }
    // The nearest GPS time. Seconds outside of +/- 9e9 give the nearest bound, NaN gives zero.
    static std::chrono::nanoseconds ToNanoseconds(double gpsTimeSeconds);

protected:
    RabitClock() = default;
};

}  // namespace Rabit
