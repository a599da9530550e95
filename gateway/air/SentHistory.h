#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace Rabit
{

// The number of bytes sent until any time in the last 20 s. Time is kept in steps of 20 ms; within one, bytes
// count as spread evenly. A datagram costs two comparisons and an addition; only the first one allocates.
//
// Pure; `now` never goes back.
class SentHistory
{
public:
    using Duration = std::chrono::nanoseconds;

    SentHistory();

    void Add(std::size_t bytes, Duration now);
    // Bytes sent from one time to a later one, not later than the newest `now`. Older bytes are not counted.
    double Between(Duration from, Duration to) const;
    // Least capacity, in bytes a second, of a channel that had carried all bytes until `to` by `arrived`,
    // which is later than `to`. It is the maximum, over any time t since `from`, of the bytes sent from t to
    // `to` divided by arrived - t. The capacity equals this if the channel always had something to carry
    // since t.
    double CarriedAtLeast(Duration from, Duration to, Duration arrived) const;
    // The longest time between those two in which nothing was sent, to within two steps.
    Duration LongestPause(Duration from, Duration to) const;

private:
    static constexpr Duration Step = std::chrono::milliseconds(20);
    static constexpr std::size_t Steps = 1024;

    struct Mark
    {
        Duration At{0};
        std::uint64_t Total = 0;  // bytes sent before the step
    };

    double Before(Duration time) const;
    std::size_t FirstAfter(Duration time) const;
    const Mark &Nth(std::size_t i) const { return _marks[(_begin + i) % Steps]; }

    std::vector<Mark> _marks;
    std::size_t _begin = 0;
    std::size_t _count = 0;
    Duration _nextMark = Duration::min();
    Duration _last{0};
    std::uint64_t _total = 0;
};

}  // namespace Rabit
