#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace Rabit
{

// How many bytes were sent until some time in the last 20 s. Time is kept in steps of 20 ms; within one,
// bytes count as spread evenly. Two comparisons and an addition per datagram, and no allocation but the
// first.
//
// Pure; `now` never goes back.
class SentHistory
{
public:
    using Duration = std::chrono::nanoseconds;

    SentHistory();

    void Add(std::size_t bytes, Duration now);
    // Bytes sent from one time to a later one, not later than the newest `now`. What is too long ago is not
    // counted.
    double Between(Duration from, Duration to) const;
    // Bytes a second: the most, for any time since `from`, of what was sent from then to `to`, over the time
    // from then to `arrived`, which is later than `to`. What carried all this until then, carried so much at
    // least; and no more, if it always had something to carry since that time.
    double CarriedAtLeast(Duration from, Duration to, Duration arrived) const;
    // The longest time between those two in which nothing was sent, to within two steps.
    Duration LongestPause(Duration from, Duration to) const;

private:
    static constexpr Duration Step = std::chrono::milliseconds(20);
    static constexpr std::size_t Steps = 1024;

    struct Mark
    {
        Duration At{0};
        std::uint64_t Total = 0;  // sent before
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
