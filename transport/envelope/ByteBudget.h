#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

// Bounds how many bytes go out in a second: a token bucket that may go below zero by one datagram. Time is
// passed in. Not thread-safe.
class ByteBudget
{
public:
    // Of IP and UDP, which are counted with each datagram.
    static constexpr std::size_t IpAndUdp = 28;

    // `rate`: bytes in each second. `burst`: the most that is saved up, and what there is at first.
    ByteBudget(double rate, double burst) : _rate(rate), _burst(burst), _left(burst) {}

    // True if a datagram may go now.
    bool IsFree(TimePoint now)
    {
        if (now > _filledAt)
        {
            _left = std::min(_left + _rate * std::chrono::duration<double>(now - _filledAt).count(), _burst);
            _filledAt = now;
        }
        return _left >= 0.0;
    }
    // From when on a datagram may go.
    TimePoint Free() const
    {
        using Span = TimePoint::duration;
        return _left >= 0.0
                   ? TimePoint{}
                   : _filledAt + std::chrono::ceil<Span>(std::chrono::duration<double>(-_left / _rate)) +
                         Span(1);
    }
    // A datagram of so many bytes went, headers of IP and UDP not counted.
    void Take(std::size_t bytes) { _left -= static_cast<double>(bytes + IpAndUdp); }

private:
    double _rate;
    double _burst;
    double _left;
    TimePoint _filledAt{};
};

}  // namespace Rabit::Envelope
