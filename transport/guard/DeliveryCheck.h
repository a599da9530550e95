// Checks submessages that carry samples or manage their delivery, and reads their fields.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// True if the builtin writer is one of discovery or liveliness.
bool IsKnownBuiltin(EntityId writer);
bool IsWriter(EntityId entity);
bool IsReader(EntityId entity);

// No honest writer exceeds this: a thousand samples a second take thirty years to reach it.
constexpr std::int64_t LargestSequence = std::int64_t{1} << 40;

// Fields of a sound submessage; those that its kind does not have are 0 or empty.
struct Delivery
{
    EntityId Reader = 0;  // 0: all readers
    EntityId Writer = 0;
    // Range of sample numbers: one sample, the range of a heartbeat, the samples that a gap declares absent,
    // or those that an acknowledgement requests. Last may be First - 1: none.
    std::int64_t First = 0;
    std::int64_t Last = 0;
    // Fragments of the sample: those carried or those requested.
    std::uint32_t FirstFragment = 0;
    std::uint32_t LastFragment = 0;
    std::uint16_t FragmentSize = 0;
    std::uint32_t SampleSize = 0;
    // Offset in the body of the count that identifies repeats; 0: there is none.
    std::size_t CountAt = 0;
    // For a sample:
    bool Alive = false;
    std::span<std::uint8_t> Payload;        // in the submessage
    std::span<const std::uint8_t> KeyHash;  // from the inline QoS
    bool HasKeyPayload = false;             // the payload is a key, not a sample
};

// For submessages that IsDelivery. Empty if the submessage is unsound: a length that does not fit, an
// impossible number, a range that no honest writer sends, entities of the wrong kind.
std::optional<Delivery> CheckDelivery(const Submessage &submessage);

}  // namespace Rabit::Rtps
