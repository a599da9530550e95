#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "gateway.idl.h"

namespace Rabit
{

// A beat, and its sample information from the transport.
struct HeardBeat
{
    std::string Node;  // the node that wrote it, and its incarnation
    std::uint64_t Incarnation = 0;
    std::int64_t Utc = 0;        // the writer's wall clock, nanoseconds since 1970
    std::uint64_t Sequence = 0;  // its writer's sequence number; 0: not known
    Gateway::Beat Beat;
    std::chrono::nanoseconds Arrival{0};  // by this node's monotonic clock
};

}  // namespace Rabit
