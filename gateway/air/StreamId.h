#pragma once

#include <cstdint>

namespace Rabit
{

// A stream of an AirSchedule. The id of a removed stream is never reused.
struct StreamId
{
    std::uint32_t Index = 0;
    std::uint32_t Life = 0;

    friend bool operator==(const StreamId &, const StreamId &) = default;
};

}  // namespace Rabit
