#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "gateway.idl.h"

namespace Rabit
{

// A beat, and what the transport says of it.
struct HeardBeat
{
    std::string Node;  // who wrote it, in which life
    std::uint64_t Incarnation = 0;
    std::int64_t Utc = 0;        // what the writer's wall clock showed, nanoseconds since 1970
    std::uint64_t Sequence = 0;  // which of its writer's samples it is; 0: not known
    Gateway::Beat Beat;
    std::chrono::nanoseconds Arrival{0};  // by this node's monotonic clock
};

}  // namespace Rabit
