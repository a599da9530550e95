#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace Rabit::Merge
{

// A reading of a clock, or a length of time, in nanoseconds. No further from 0 than FarthestMoment (the
// year 2067), so that three of them can be added up, whatever a file holds.
using Moment = std::int64_t;

inline constexpr Moment FarthestMoment = std::numeric_limits<Moment>::max() / 3;
inline constexpr Moment OneSecond = 1000000000;

inline Moment Within(Moment moment)
{
    return std::clamp(moment, -FarthestMoment, FarthestMoment);
}

// Convert a time of a file to a Moment, and back.
inline Moment FromFile(std::uint64_t time)
{
    return static_cast<Moment>(std::min(time, static_cast<std::uint64_t>(FarthestMoment)));
}
inline std::uint64_t ToFile(Moment moment)
{
    return moment < 0 ? 0 : static_cast<std::uint64_t>(moment);
}

// A part of a length of time, such as what a drift adds up to.
inline Moment PartOf(Moment length, double part)
{
    const double product = static_cast<double>(length) * part;
    return static_cast<Moment>(
        std::clamp(product, static_cast<double>(-FarthestMoment), static_cast<double>(FarthestMoment)));
}

inline Moment Apart(Moment left, Moment right)
{
    return Within(std::abs(left - right));
}

}  // namespace Rabit::Merge
