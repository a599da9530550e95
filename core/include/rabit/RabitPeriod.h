#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

namespace Rabit
{

// The turns of a period: moments exactly a period apart, counted from its beginning, even if a turn is
// taken late. The caller passes the time: there is no clock in here. Not thread-safe.
class RabitPeriod
{
public:
    // Sets the period; zero or less: no period. A different value begins a new period; the same value
    // changes nothing.
    void Set(std::chrono::nanoseconds period)
    {
        period = std::max(period, std::chrono::nanoseconds::zero());
        if (period != _period)
        {
            _period = period;
            _next.reset();
        }
    }
    std::chrono::nanoseconds Get() const { return _period; }
    bool IsSet() const { return _period > std::chrono::nanoseconds::zero(); }

    // Begins the period with a turn at `start`, which counts as taken; the next turn is one period later.
    void Begin(std::chrono::nanoseconds start) { _next = start + _period; }
    // The next turn; the period must be set. Before Begin: the next turn of a period that began at `start`.
    std::chrono::nanoseconds Next(std::chrono::nanoseconds start) const
    {
        return _next ? *_next : start + _period;
    }
    // Takes all turns that have come by `now`, and returns whether there was one. All but the last of them
    // are missed. A period that has not begun begins at `start`, or at `now` if its first turn has already
    // come: turns before the period was set do not count as missed.
    bool Take(std::chrono::nanoseconds start, std::chrono::nanoseconds now)
    {
        if (!_next)
        {
            const bool come = now >= start + _period;
            Begin(come ? now : start);
            return come;
        }
        if (now < *_next)
        {
            return false;
        }
        const auto late = (now - *_next) / _period;
        _missed += static_cast<std::uint64_t>(late);
        *_next += (late + 1) * _period;
        return true;
    }
    // Missed turns since construction.
    std::uint64_t Missed() const { return _missed; }

private:
    std::chrono::nanoseconds _period{0};
    std::optional<std::chrono::nanoseconds> _next;
    std::uint64_t _missed = 0;
};

}  // namespace Rabit
