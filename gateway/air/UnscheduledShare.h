#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>

namespace Rabit
{

// How much of a budget is to be kept free for what is not scheduled: what DDS says of its own accord. That is
// the participant's announcement, once a period, and what is said when nodes come. A budget holds in each
// second, so what will be said within a second must find its place; but to keep that free all the time would
// be a waste of most of a small budget. So:
//
// - What was said a period ago is expected again now: it has its place from a second before, as long as it
//   may come late.
// - While much is said, as much is expected further on.
//
// The first of several nodes that come finds no place, nor does an announcement out of turn: for that second
// what was sent before it cannot be taken back.
//
// Bounded: what went within Together is one. Pure; `now` never goes back.
class UnscheduledShare
{
public:
    using Duration = std::chrono::nanoseconds;
    // An announcement has no more than that, and no more is kept free for it.
    static constexpr std::size_t Lump = 600;
    // How much earlier or later than after a period it may come.
    static constexpr Duration Early = std::chrono::milliseconds(150);
    static constexpr Duration Late = std::chrono::milliseconds(500);
    // Of whatever second it falls into (SlidingSecond).
    static constexpr Duration Before = std::chrono::milliseconds(1050);
    // More than a lump within that is a conversation.
    static constexpr Duration Recent = std::chrono::seconds(2);

    // period: of the announcements.
    explicit UnscheduledShare(Duration period) : _period(period) {}

    // So many bytes were said after `since`, when this was last looked at, until now.
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

    // When something was said: after Since, at At at the latest.
    struct Said
    {
        Duration Since{0};
        Duration At{0};
        std::size_t Bytes = 0;
    };

    // Bytes that may have begun to be said then.
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
