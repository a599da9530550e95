#pragma once

#include <chrono>
#include <cstdint>

namespace Rabit
{

// Returns the shortest time between two values at `maxRate` values a second; 0: no limit. The longest is a
// year, so that a rate near 0 does not overflow: the result of that differs between processors.
inline std::chrono::nanoseconds GapOfRate(double maxRate)
{
    constexpr std::chrono::nanoseconds longest = std::chrono::hours(24 * 365);
    const double gap = maxRate > 0.0 ? 1e9 / maxRate : 0.0;
    return gap < static_cast<double>(longest.count())
               ? std::chrono::nanoseconds(static_cast<std::int64_t>(gap))
               : longest;
}

}  // namespace Rabit
