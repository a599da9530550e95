#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

namespace Rabit::Backfill
{

// Number of a post within its series: the source time of its sample in steps of 1024 ns, as
// mirrors/StateVersion.h divides time. Samples carry source times in the middle of a step, and recordings
// the exact time of the post, so both tell the same stamp.
using Stamp = std::uint64_t;
inline constexpr std::int64_t StampStep = 1024;

constexpr Stamp StampOf(std::int64_t sourceTime)
{
    return sourceTime < 0 ? 0 : static_cast<Stamp>(sourceTime / StampStep);
}
constexpr std::int64_t TimeOf(Stamp stamp)
{
    return static_cast<std::int64_t>(stamp) * StampStep;
}
// Steps in that many nanoseconds.
constexpr Stamp StepsIn(std::int64_t nanoseconds)
{
    return StampOf(nanoseconds);
}

// The posts of one message by one incarnation of a node.
struct Series
{
    std::string Node;
    std::string Message;
    std::uint64_t Incarnation = 0;

    auto operator<=>(const Series &) const = default;
};

// A post, as its origin node recorded it.
struct Post
{
    std::int64_t SourceTime = 0;  // exact
    std::vector<std::uint8_t> Bytes;

    bool operator==(const Post &) const = default;
};

// The stamps from First on and below End.
struct Range
{
    Stamp First = 0;
    Stamp End = 0;

    bool operator==(const Range &) const = default;
    bool IsEmpty() const { return First >= End; }
    bool Contains(Stamp stamp) const { return stamp >= First && stamp < End; }
};

}  // namespace Rabit::Backfill
