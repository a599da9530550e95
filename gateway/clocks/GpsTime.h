#pragma once

#include <cstdint>

namespace Rabit::GpsTime
{

// Messages carry GPS seconds since 1980-01-06, DDS samples carry UTC since 1970-01-01. These convert with the
// leap seconds that SystemTimeClock is set to; ToGps(ToUtcNanoseconds(t)) == t for every time stamp from 1980
// to 2200. A GPS time outside the range that fits (about 1948 to 2233) is clamped to it; NaN becomes 0.
std::int64_t ToUtcNanoseconds(double gpsSeconds);
double ToGps(std::int64_t utcNanoseconds);

}  // namespace Rabit::GpsTime
