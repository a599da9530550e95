#pragma once

#include <chrono>
#include <optional>

namespace Rabit
{

// Lets a line through at most once in a period, for logs about what arrives from the network. Not
// thread-safe.
class LogThrottle
{
public:
    explicit LogThrottle(std::chrono::nanoseconds period = std::chrono::minutes(1)) : _period(period) {}

    bool MayPass(std::chrono::nanoseconds now)
    {
        if (_last && now - *_last < _period)
        {
            return false;
        }
        _last = now;
        return true;
    }

private:
    std::chrono::nanoseconds _period;
    std::optional<std::chrono::nanoseconds> _last;
};

}  // namespace Rabit
