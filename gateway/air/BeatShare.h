#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace Rabit
{

// How often a node beats, by what its beats may take of a channel.
struct BeatShare
{
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration Quickest = std::chrono::milliseconds(500);
    // Share of a budget.
    static constexpr double OfBudget = 0.05;
    // Share of a capacity estimate: half of the share of presence where other classes want to send. Not less,
    // since the reports on which the estimate rests come with the other nodes' beats.
    static constexpr double OfCapacity = 0.125;
    // No setting asks for rare beats there, and an estimate may come from bad weather alone.
    static constexpr Duration SlowestOfCapacity = std::chrono::seconds(1);

    // The period in which beats of that size on the air take their share of the budget, within `slowest`, or
    // of the capacity if that is less. Rates are bytes per second; empty: no limit.
    static Duration PeriodOf(double beatBytes, std::optional<double> budget, Duration slowest,
                             std::optional<double> capacity = std::nullopt)
    {
        Duration period = Quickest;
        if (budget)
        {
            period = PeriodAt(beatBytes, OfBudget * *budget, slowest);
        }
        if (capacity)
        {
            period = std::max(period, PeriodAt(beatBytes, OfCapacity * *capacity, SlowestOfCapacity));
        }
        return period;
    }

private:
    static Duration PeriodAt(double beatBytes, double bytesPerSecond, Duration slowest)
    {
        const auto period =
            std::chrono::duration_cast<Duration>(std::chrono::duration<double>(beatBytes / bytesPerSecond));
        return std::clamp(period, Quickest, std::max(Quickest, slowest));
    }
};

}  // namespace Rabit
