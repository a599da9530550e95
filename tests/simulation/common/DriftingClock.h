#pragma once

#include <chrono>
#include <cstdint>

namespace Rabit::Sim
{

// The monotonic clock of one process: starts at its own reading and runs at its own rate.
struct DriftingClock
{
    using Time = std::chrono::nanoseconds;

    Time StartedAt{0};  // true time
    Time Offset{0};
    std::int64_t DriftPpm = 0;

    Time At(Time trueTime) const
    {
        const std::int64_t passed = (trueTime - StartedAt).count();
        return Offset + Time(passed + passed / Million * DriftPpm + passed % Million * DriftPpm / Million);
    }
    // The first true time at which it shows `reading` or more.
    Time TrueTimeOf(Time reading) const
    {
        const double passed = static_cast<double>((reading - Offset).count()) /
                              (1.0 + static_cast<double>(DriftPpm) / static_cast<double>(Million));
        Time trueTime = StartedAt + Time(static_cast<std::int64_t>(passed) - 2);
        while (At(trueTime) < reading)
        {
            ++trueTime;
        }
        return trueTime;
    }

private:
    static constexpr std::int64_t Million = 1'000'000;
};

}  // namespace Rabit::Sim
