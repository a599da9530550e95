// Times that Python programs give.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace Rabit::Python
{

// Longer times, infinity included, are taken as this, which can be added to any clock.
inline constexpr std::chrono::nanoseconds Forever = std::chrono::hours(24 * 365 * 100);

// The one conversion of seconds. Raises ValueError for a NaN. Negative times are none.
inline std::chrono::nanoseconds DurationOf(double seconds)
{
    if (std::isnan(seconds))
    {
        throw pybind11::value_error("expected a number of seconds, not nan");
    }
    constexpr double most = std::chrono::duration<double>(Forever).count();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double>(std::clamp(seconds, 0.0, most)));
}

}  // namespace Rabit::Python
