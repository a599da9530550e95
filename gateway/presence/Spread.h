#pragma once

#include <rabit/gateway/RandomSource.h>

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace Rabit
{

// Returns a random delay for a node that answers something that other nodes hear at the same moment. Its
// range grows with their number.
inline std::chrono::nanoseconds SpreadAmong(std::size_t others, const RandomSource &random)
{
    constexpr std::chrono::nanoseconds forOne = std::chrono::milliseconds(2);
    constexpr std::chrono::nanoseconds longest = std::chrono::milliseconds(100);
    const auto count = static_cast<std::chrono::nanoseconds::rep>(std::min<std::size_t>(others, 1000));
    const std::chrono::nanoseconds most = std::min(count * forOne, longest);
    return std::chrono::nanoseconds(static_cast<std::chrono::nanoseconds::rep>(
        random() % (static_cast<std::uint64_t>(most.count()) + 1)));
}

}  // namespace Rabit
