#pragma once

#include <chrono>

namespace Rabit
{

// Time and durations of the queue links. A point in time is a reading of the process's monotonic clock (for
// instance std::chrono::steady_clock::now().time_since_epoch()), handed in by the caller: never negative, and
// never lower than the reading handed in before. It means nothing in another process.
using LinkTime = std::chrono::nanoseconds;

// "Never": later than every reading.
inline constexpr LinkTime LinkNever = LinkTime::max();

}  // namespace Rabit
