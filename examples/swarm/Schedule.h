#pragma once

#include <chrono>

namespace Swarm
{

// Beats at a steady rate, for a manager that sleeps in whole milliseconds. Deadlines are multiples of the
// period from the first beat, so that lateness does not add up. Missed beats are skipped. Not thread-safe.
// Times are of any clock that does not go back.
class Schedule
{
public:
    using Duration = std::chrono::nanoseconds;

    explicit Schedule(Duration period) : _period(period) {}

    // If a beat is due at that time, returns true and sets the next one. The first call is the first beat.
    bool Due(Duration now)
    {
        if (!_started)
        {
            _started = true;
            _next = now;
        }
        if (now < _next)
            return false;
        _next += _period * (1 + (now - _next) / _period);
        return true;
    }

    // Milliseconds to sleep until the next beat, rounded up; 0 if it is due.
    int DelayMSec(Duration now) const
    {
        if (!_started || now >= _next)
            return 0;
        return static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(_next - now).count());
    }

private:
    Duration _period;
    Duration _next{0};
    bool _started = false;
};

}  // namespace Swarm
