#pragma once

#include <cstdint>

namespace Rabit::StateVersion
{

// The version of a State is taken from the source time of its sample, so that whoever has the sample knows
// the version without being told, and a beat carries 4 bytes for it. Sample times are put into the middle of
// a step of 1024 ns: what a backend rounds on the way does not change the version. Versions come again after
// 73 minutes; with a time that is known to be later than the sample they are told apart.

inline constexpr std::int64_t Step = 1024;
// No version: nothing was written yet.
inline constexpr std::uint32_t None = 0;

// Of a sample of that source time, in ns.
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

// The source time for what follows on a quantised time within the same step.
constexpr std::int64_t Next(std::int64_t quantised)
{
    return Quantised(quantised + Step);
}

// Whether two source times are of one version, and not merely of versions that came again.
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
