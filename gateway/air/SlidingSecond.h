#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace Rabit
{

// The bytes of the last second, wherever it begins. Datagrams within a 256th of a second are remembered
// together, as if all of them had been sent at its end. So memory is bounded at any rate, the sums are never
// too low, and they are exact where datagrams are further apart.
//
// "A second" is 50 ms longer here: a radio shifts datagrams while others are on the air. Bytes that left a
// node in 1001 ms must not fall into one second of the air.
//
// Pure; `now` never goes back.
class SlidingSecond
{
public:
    using Duration = std::chrono::nanoseconds;
    static constexpr Duration Length = std::chrono::milliseconds(1050);

    // Adds scheduled and unscheduled bytes.
    void Add(std::uint64_t scheduled, std::uint64_t unscheduled, Duration now);
    std::uint64_t Scheduled(Duration now);
    std::uint64_t Unscheduled(Duration now);

    // The first time, not before now, at which `fits(scheduled, unscheduled)` holds if nothing is added. It
    // must hold for (0, 0).
    template <typename Condition>
    Duration When(const Condition &fits, Duration now);

private:
    static constexpr Duration Together = std::chrono::nanoseconds(1'000'000'000 / 256);

    struct Entry
    {
        Duration First{0};
        Duration Last{0};
        std::uint64_t Scheduled = 0;
        std::uint64_t Unscheduled = 0;
    };

    void Forget(Duration now);
    Entry &At(std::size_t i) { return _entries[(_begin + i) % _entries.size()]; }

    // Those whose last byte is not older than Length, a new one each Together at most.
    std::array<Entry, 264> _entries{};
    std::size_t _begin = 0;
    std::size_t _count = 0;
    std::uint64_t _scheduled = 0;
    std::uint64_t _unscheduled = 0;
};

template <typename Condition>
SlidingSecond::Duration SlidingSecond::When(const Condition &fits, Duration now)
{
    Forget(now);
    std::uint64_t scheduled = _scheduled;
    std::uint64_t unscheduled = _unscheduled;
    Duration when = now;
    for (std::size_t i = 0; i < _count && !fits(scheduled, unscheduled); ++i)
    {
        scheduled -= At(i).Scheduled;
        unscheduled -= At(i).Unscheduled;
        when = At(i).Last + Length;
    }
    return when;
}

}  // namespace Rabit
