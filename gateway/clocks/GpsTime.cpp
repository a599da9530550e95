#include "clocks/GpsTime.h"

#include <rabit/SystemTimeClock.h>

#include <algorithm>
#include <cmath>

namespace Rabit::GpsTime
{
namespace
{

// 1980-01-06 in seconds since 1970-01-01.
constexpr std::int64_t GpsEpoch = 315964800;
constexpr std::int64_t Second = 1'000'000'000;
// About the year 2233: the nanoseconds of it still fit 63 bits.
constexpr double FarthestSecond = 8.0e9;

std::int64_t EpochDifference()
{
    return GpsEpoch - std::llround(SystemTimeClock::GetSystemTimeClock()->GetLeapSecondOffset());
}

}  // namespace

std::int64_t ToUtcNanoseconds(double gpsSeconds)
{
    const double bounded = std::isnan(gpsSeconds) ? 0.0 : std::clamp(gpsSeconds, -1.0e9, FarthestSecond);
    const double whole = std::floor(bounded);
    // Split, because the product would need more bits than a double has.
    return (static_cast<std::int64_t>(whole) + EpochDifference()) * Second +
           std::llround((bounded - whole) * 1e9);
}

double ToGps(std::int64_t utcNanoseconds)
{
    std::int64_t seconds = utcNanoseconds / Second;
    std::int64_t nanoseconds = utcNanoseconds % Second;
    if (nanoseconds < 0)
    {
        --seconds;
        nanoseconds += Second;
    }
    return static_cast<double>(seconds - EpochDifference()) + static_cast<double>(nanoseconds) * 1e-9;
}

}  // namespace Rabit::GpsTime
