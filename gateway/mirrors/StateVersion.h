#pragma once

#include <cstdint>

namespace Rabit::StateVersion
{

// The version of a State follows from the source time of its sample. So a node that has the sample knows the
// version, and a beat carries 4 bytes for it. Sample times are put into the middle of a step of 1024 ns:
// rounding by a backend does not change the version. Versions repeat after 73 minutes; a time that is known
// to be later than the sample tells them apart.

inline constexpr std::int64_t Step = 1024;
// No version: nothing was written yet.
inline constexpr std::uint32_t None = 0;

// The version of a sample with that source time, in ns.
constexpr std::uint32_t Of(std::int64_t sourceTime)
{
    return static_cast<std::uint32_t>((sourceTime & ~(Step - 1)) / Step);
}

// The source time for a State of that time, or one step later where the version would be None.
constexpr std::int64_t Quantised(std::int64_t time)
{
    const std::int64_t middle = (time & ~(Step - 1)) + Step / 2;
    return Of(middle) == None ? middle + Step : middle;
}

// The source time for a State that follows a quantised time within the same step.
constexpr std::int64_t Next(std::int64_t quantised)
{
    return Quantised(quantised + Step);
}

// True if two source times have one version, and not merely a repeated one.
constexpr bool IsSame(std::int64_t sourceTime, std::int64_t other)
{
    return (sourceTime & ~(Step - 1)) == (other & ~(Step - 1));
}

// The latest quantised time of that version that is not after the given one.
constexpr std::int64_t LatestOf(std::uint32_t version, std::int64_t notAfter)
{
    const std::int64_t middle = (notAfter & ~(Step - 1)) + Step / 2;
    const std::int64_t last = middle > notAfter ? middle - Step : middle;
    return last - static_cast<std::int64_t>(Of(last) - version) * Step;
}

}  // namespace Rabit::StateVersion
