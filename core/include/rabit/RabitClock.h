#pragma once

#include <chrono>
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

protected:
    RabitClock() = default;
};

}  // namespace Rabit
