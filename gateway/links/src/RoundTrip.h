#pragma once

#include <rabit/gateway/links/LinkTime.h>

#include <chrono>

namespace Rabit
{

// The time of a frame as its echo tells it: in whole microseconds.
constexpr LinkTime AsEchoed(LinkTime time)
{
    return std::chrono::floor<std::chrono::microseconds>(time);
}

// The smoothed round trip of a path and its variation, as RFC 6298 has them. Every frame carries the time of
// the newest one that came the other way (RFC 7323). So each gives a measurement, even if data was sent
// twice.
class RoundTrip
{
public:
    void Measured(LinkTime roundTrip);

    bool IsKnown() const { return _smoothed > LinkTime(0); }
    LinkTime Latest() const { return _latest; }
    LinkTime Smoothed() const { return _smoothed; }    // SRTT; 0 before the first measurement
    LinkTime Variation() const { return _variation; }  // RTTVAR

private:
    LinkTime _latest{0};
    LinkTime _smoothed{0};
    LinkTime _variation{0};
};

}  // namespace Rabit
