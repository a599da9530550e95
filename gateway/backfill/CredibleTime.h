#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace Rabit::Backfill
{

// A long gap takes hours to arrive over a slow channel: posts grow older on their way.
inline constexpr std::chrono::nanoseconds LongestWay = std::chrono::hours(24);
// Clocks of two nodes agree to this, and posts are requested a second after their time.
inline constexpr std::chrono::nanoseconds MostAhead = std::chrono::seconds(1);

// True if a post with that log time can have been requested: it is neither in the future, nor older than
// `last` and LongestWay together. Times are UTC, nanoseconds since 1970.
inline bool IsCredible(std::uint64_t time, std::uint64_t now, std::chrono::nanoseconds last)
{
    const auto oldest = static_cast<std::uint64_t>((last + LongestWay).count());
    const auto ahead = static_cast<std::uint64_t>(MostAhead.count());
    return time <= now + ahead && time >= now - std::min(now, oldest);
}

}  // namespace Rabit::Backfill
