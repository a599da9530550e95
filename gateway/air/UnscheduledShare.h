#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>

namespace Rabit
{

// Computes the part of a budget to keep free for DDS's own, unscheduled traffic: the participant's
// announcement once a period, and discovery when nodes come. A budget holds in each second, so this traffic
// needs room in the second in which it comes. But to keep room free all the time would waste most of a small
// budget. So:
//
// - Traffic of a period ago is expected again now: room is kept from a second before, until it can no longer
//   come late.
// - While there is much traffic, as much is expected to follow.
//
// The traffic for the first of several new nodes finds no room, nor does an announcement out of turn: bytes
// already sent in that second cannot be taken back.
//
// Bounded: bytes within Together are one entry. Pure; `now` never goes back.
class UnscheduledShare
{
public:
    using Duration = std::chrono::nanoseconds;
    // Largest announcement, and the most that is kept free for it.
    static constexpr std::size_t Lump = 600;
    // How much earlier or later than after a period it may come.
    static constexpr Duration Early = std::chrono::milliseconds(150);
    static constexpr Duration Late = std::chrono::milliseconds(500);
    // Room is kept from this time before, for any second that the announcement may fall into (SlidingSecond).
    static constexpr Duration Before = std::chrono::milliseconds(1050);
    // More than a lump within this time is a conversation, not an announcement.
    static constexpr Duration Recent = std::chrono::seconds(2);

    // period: time between the participant's announcements.
    explicit UnscheduledShare(Duration period) : _period(period) {}

    // `bytes` bytes were sent after `since`, the time of the last call, until now.
    void Add(std::size_t bytes, Duration since, Duration now)
    {
        while (!_said.empty() && now - _said.front().At > _period + Late + Together)
        {
            _said.pop_front();
        }
        if (_said.empty() || now - _said.back().At >= Together)
        {
            _said.push_back({since, now, 0});
        }
        _said.back().Bytes += bytes;
    }

    // Bytes a second.
    double Rate(Duration now) const
    {
        const std::size_t expected =
            std::min(Between(now - _period - Late, now - _period + Early + Before), Lump);
        const std::size_t recent = Between(now - Recent, now);
        const double goesOn =
            recent > Lump ? static_cast<double>(recent) / std::chrono::duration<double>(Recent).count() : 0.0;
        return std::max(static_cast<double>(expected), goesOn);
    }

private:
    static constexpr Duration Together = std::chrono::milliseconds(100);

    // The time of some traffic: after Since, at At at the latest.
    struct Said
    {
        Duration Since{0};
        Duration At{0};
        std::size_t Bytes = 0;
    };

    // Bytes whose sending may have begun in that time.
    std::size_t Between(Duration from, Duration to) const
    {
        std::size_t bytes = 0;
        for (const Said &said : _said)
        {
            bytes += said.At >= from && said.Since <= to ? said.Bytes : 0;
        }
        return bytes;
    }

    const Duration _period;
    std::deque<Said> _said;  // the oldest first
};

}  // namespace Rabit
