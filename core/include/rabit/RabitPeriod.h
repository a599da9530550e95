#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

namespace Rabit
{

// The turns of a period: moments that are exactly a period apart, counted from its beginning, however late
// each of them is taken. Knows no clock: whoever has one asks. Not thread-safe.
class RabitPeriod
{
public:
    // Zero or less: none. Another period than before begins anew; the same one goes on as it is.
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

    // The next turn is a period after `start`, which is itself one that was taken.
    void Begin(std::chrono::nanoseconds start) { _next = start + _period; }
    // Of a period that is set. Before Begin: if it began at `start`.
    std::chrono::nanoseconds Next(std::chrono::nanoseconds start) const
    {
        return _next ? *_next : start + _period;
    }
    // Takes all turns that have come by now, and says whether there was one. All but the last of them are
    // missed. A period that has not begun began at `start`, or now if its first turn has come already: what
    // lies before it was set is not missed.
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
    // Since construction.
    std::uint64_t Missed() const { return _missed; }

private:
    std::chrono::nanoseconds _period{0};
    std::optional<std::chrono::nanoseconds> _next;
    std::uint64_t _missed = 0;
};

}  // namespace Rabit
