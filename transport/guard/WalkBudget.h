// Bounds how many sample numbers the vendor walks through.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace Rabit::Rtps
{

// Fast DDS steps one by one through all numbers that a heartbeat or a gap declares absent, with its locks
// held (CVE-2025-65016). A step takes 5 to 25 ns. So a single heartbeat could occupy it for hours. This class
// counts the steps for all writers together. Time is passed in. Not thread-safe.
class WalkBudget
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // Steps for each datagram, whatever others took: about what it costs to receive one.
    static constexpr std::int64_t Free = 256;
    // Steps at once: a tenth of a second at most. A reader that joins a writer at number 4,000,000 needs
    // them.
    static constexpr std::int64_t Burst = std::int64_t{1} << 22;
    // Steps in a second: 7 ms of one processor at most.
    static constexpr std::int64_t InASecond = std::int64_t{1} << 18;

    // Returns how many of `wanted` steps may be made now, and counts them.
    std::int64_t Take(std::int64_t wanted, TimePoint now)
    {
        constexpr std::chrono::milliseconds UntilFull{1000 * Burst / InASecond};
        const auto since = std::clamp(std::chrono::duration_cast<std::chrono::milliseconds>(now - _filled),
                                      std::chrono::milliseconds(0), UntilFull);
        _left = std::min(_left + since.count() * InASecond / 1000, Burst);
        _filled = now;
        const std::int64_t granted = std::clamp(wanted - Free, std::int64_t{0}, _left);
        _left -= granted;
        return std::min(wanted, Free + granted);
    }

private:
    std::int64_t _left = Burst;
    TimePoint _filled{};
};

}  // namespace Rabit::Rtps
