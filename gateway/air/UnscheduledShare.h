#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace Rabit
{

// How much of a budget is to be kept free for what is not scheduled: what DDS says of its own accord. That
// comes in lumps, half a minute apart, and a budget holds in each second; so it is the most that went in a
// second of the last half to whole minute. No more than Lump, which is a participant's announcement, or what
// went on average: when nodes come DDS says a multiple of that, and to keep it free for ever would be a
// waste.
//
// Pure; `now` never goes back.
class UnscheduledShare
{
public:
    using Duration = std::chrono::nanoseconds;
    static constexpr Duration Memory = std::chrono::seconds(35);
    static constexpr double Lump = 600.0;

    void Add(std::size_t bytes, Duration now)
    {
        Turn(now);
        _second += bytes;
        _now.Bytes += bytes;
        _now.Most = std::max(_now.Most, _second);
    }

    // Bytes a second.
    double Rate(Duration now)
    {
        Turn(now);
        const double most = static_cast<double>(std::max(_now.Most, _before.Most));
        const double average =
            static_cast<double>(_now.Bytes + _before.Bytes) / std::chrono::duration<double>(Memory).count();
        return std::min(most, std::max(Lump, average));
    }

private:
    struct Part
    {
        std::size_t Most = 0;  // in a second
        std::size_t Bytes = 0;
    };

    void Turn(Duration now)
    {
        if (now - _secondBegan >= std::chrono::seconds(1))
        {
            _secondBegan = now;
            _second = 0;
        }
        if (now - _partBegan >= Memory)
        {
            _before = now - _partBegan >= 2 * Memory ? Part{} : _now;
            _now = {};
            _partBegan = now;
        }
    }

    Duration _secondBegan{0};
    Duration _partBegan{0};
    std::size_t _second = 0;
    Part _now;
    Part _before;
};

}  // namespace Rabit
