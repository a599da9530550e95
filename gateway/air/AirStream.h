#pragma once

#include <rabit/gateway/TrafficClass.h>

#include <cstddef>
#include <cstdint>

namespace Rabit
{

// The record of a stream that AirSchedule and FairQueue share.
struct AirStream
{
    static constexpr std::size_t NotWaiting = static_cast<std::size_t>(-1);

    std::uint32_t Index = 0;
    std::uint32_t Life = 0;
    bool IsThere = false;
    TrafficClass Class = TrafficClass::Bulk;
    double Weight = 1.0;
    std::size_t Bytes = 0;           // of its next datagram
    std::uint64_t Sent = 0;          // bytes in all
    std::uint64_t Destinations = 0;  // of its last datagram; 0: not known

    // Used by FairQueue.
    double Tag = 0.0;                    // virtual time at which its next datagram begins
    std::uint64_t Arrived = 0;           // order among equal tags
    std::size_t HeapPlace = NotWaiting;  // in the queue
};

}  // namespace Rabit
