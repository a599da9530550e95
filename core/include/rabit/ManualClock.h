#pragma once

#include <rabit/RabitClock.h>

#include <atomic>
#include <chrono>
#include <cstdint>

namespace Rabit
{

// A clock that moves only by its own methods. For stepped reactors, simulations and tests.
//
// Thread-safe: one thread may move it while others read it. A manager that runs on a thread of its own still
// sleeps in real time; use RabitSteppedReactor to have its sleep follow this clock.
class ManualClock : public RabitClock
{
public:
    // Starts at the given GPS time, with the monotonic clock at `monotonic`.
    explicit ManualClock(double gpsTimeSeconds = 0.0,
                         std::chrono::nanoseconds monotonic = std::chrono::nanoseconds{0});

    std::chrono::nanoseconds Monotonic() const override;
    double GpsTimeSeconds() const override;

    // Moves both clocks on. Throws std::invalid_argument if the duration is negative.
    void Advance(std::chrono::nanoseconds duration);
    // Moves both clocks on to the moment at which the monotonic clock shows `monotonic`; does nothing if that
    // is not in the future.
    void AdvanceTo(std::chrono::nanoseconds monotonic);
    // Sets the wall clock, as an operator or a time daemon does; the monotonic clock does not notice.
    void SetGpsTimeSeconds(double gpsTimeSeconds);

private:
    std::atomic<std::int64_t> _monotonic;
    // GPS time when the monotonic clock shows zero.
    std::atomic<double> _gpsAtZero;
};

}  // namespace Rabit
