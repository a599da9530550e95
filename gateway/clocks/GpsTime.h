#pragma once

#include <cstdint>

namespace Rabit::GpsTime
{

// Messages carry GPS seconds since 1980-01-06, DDS samples carry UTC since 1970-01-01. These convert with the
// leap seconds that SystemTimeClock is set to; ToGps(ToUtcNanoseconds(t)) == t for every time stamp from 1980
// to 2200. A value that no clock shows (not finite, or centuries away) is taken as the nearest that one
// could.
std::int64_t ToUtcNanoseconds(double gpsSeconds);
double ToGps(std::int64_t utcNanoseconds);

}  // namespace Rabit::GpsTime
