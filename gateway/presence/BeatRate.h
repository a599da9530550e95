#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>

#include "presence/BeatPace.h"

namespace Rabit
{

// How often this node beats, by the size of its beats and what they may take of the channel. BeatPace brings
// single beats forward.
class BeatRate
{
public:
    using Duration = BeatPace::Duration;

    // Share of a budget.
    static constexpr double OfBudget = 0.05;
    // Share of a capacity estimate: half of the share of presence where other classes want to send. Not less,
    // since the reports on which the estimate rests come with the other nodes' beats.
    static constexpr double OfCapacity = 0.125;
    // No setting asks for rare beats there, and an estimate may come from bad weather alone.
    static constexpr Duration SlowestOfCapacity = std::chrono::seconds(1);
    // Without a budget peers measure the delay by the beats, so a node that sends much beats more often: once
    // in BytesForABeat times the bytes of a beat, but no sooner than BeatPace::ShortestPeriod after the last.
    static constexpr double BytesForABeat = 20.0;

    // The period in which beats of that size on the air take their share of the budget, within `slowest`, or
    // of the capacity if that is less. Rates are bytes per second; empty: no limit.
    static Duration PeriodOf(double beatBytes, std::optional<double> budget, Duration slowest,
                             std::optional<double> capacity = std::nullopt)
    {
        Duration period = BeatPace::DefaultPeriod;
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

    // Average bytes on the air of beats that waited for their turn.
    double BeatBytes() const { return _beatBytes; }
    // True if so many samples were sent since the last beat that the peers need one to measure their delay.
    bool IsWorthABeat(Duration now) const
    {
        return _sinceBeat >= BytesForABeat * _beatBytes && now >= _beatAt + BeatPace::ShortestPeriod;
    }

    void SampleBytesSent(std::size_t bytes) { _sinceBeat += static_cast<double>(bytes); }
    void BeatSent(Duration now)
    {
        _beatAt = now;
        _sinceBeat = 0.0;
    }
    // The beat that was sent last had waited for its turn, and took so many bytes on the air.
    void BeatTook(std::size_t bytes)
    {
        _sinceBeat = 0.0;
        _beatBytes = std::max(_beatBytes + (static_cast<double>(bytes) - _beatBytes) / 8.0, SmallestBeat);
    }

private:
    static constexpr double SmallestBeat = 100.0;  // on the air

    static Duration PeriodAt(double beatBytes, double bytesPerSecond, Duration slowest)
    {
        const auto period =
            std::chrono::duration_cast<Duration>(std::chrono::duration<double>(beatBytes / bytesPerSecond));
        return std::clamp(period, BeatPace::DefaultPeriod, std::max(BeatPace::DefaultPeriod, slowest));
    }

    double _beatBytes = 150.0;
    double _sinceBeat = 0.0;  // bytes of samples
    Duration _beatAt{0};
};

}  // namespace Rabit
