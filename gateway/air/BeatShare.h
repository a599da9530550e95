#pragma once

#include <algorithm>
#include <chrono>

namespace Rabit
{

// How often a node with a limited rate beats.
struct BeatShare
{
    // Share of a budget that beats take.
    static constexpr double OfBudget = 0.05;
    static constexpr std::chrono::nanoseconds Quickest = std::chrono::milliseconds(500);

    // The beat period in which beats of that size take `bytesPerSecond`.
    static std::chrono::nanoseconds PeriodOf(double beatBytes, double bytesPerSecond,
                                             std::chrono::nanoseconds slowest)
    {
        const auto period = std::chrono::duration_cast<std::chrono::nanoseconds>(
            std::chrono::duration<double>(beatBytes / bytesPerSecond));
        return std::clamp(period, Quickest, std::max(Quickest, slowest));
    }
};

}  // namespace Rabit
