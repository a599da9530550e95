// The submessages that carry samples, or manage their delivery: whether they are sound, and what they say.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Entities of discovery and liveliness (RTPS 2.3, 9.3.1.3) that we have a use for.
constexpr EntityId ParticipantEntity = 0x000001c1;
constexpr EntityId ParticipantWriter = 0x000100c2;
constexpr EntityId PublicationsWriter = 0x000003c2;
constexpr EntityId SubscriptionsWriter = 0x000004c2;
constexpr EntityId LivelinessWriter = 0x000200c2;
// Of DDS Security: writes the messages of handshakes.
constexpr EntityId HandshakeWriter = 0x000201c3;

// Whether an entity is one of the protocol's own.
bool IsBuiltin(EntityId entity);
// Whether such a writer is one of those above.
bool IsKnownBuiltin(EntityId writer);
bool IsWriter(EntityId entity);
bool IsReader(EntityId entity);

// Greater numbers are not honest: a thousand samples a second reach this after thirty years.
constexpr std::int64_t LargestSequence = std::int64_t{1} << 40;

// What a sound submessage says; what its kind does not have is 0 or empty.
struct Delivery
{
    EntityId Reader = 0;  // 0: all readers
    EntityId Writer = 0;
    // The numbers that it is about: one sample, the range of a heartbeat, what a gap says is not there, what
    // an acknowledgement asks for. Last may be First - 1: none.
    std::int64_t First = 0;
    std::int64_t Last = 0;
    // Fragments of the sample: those that come, or the ones asked for.
    std::uint32_t FirstFragment = 0;
    std::uint32_t LastFragment = 0;
    std::uint16_t FragmentSize = 0;
    std::uint32_t SampleSize = 0;
    // Where in the body the number is that repeats are told by; 0: it has none.
    std::size_t CountAt = 0;
    // Of a sample.
    bool Alive = false;
    std::span<std::uint8_t> Payload;        // in the submessage
    std::span<const std::uint8_t> KeyHash;  // from the inline QoS
    bool HasKeyPayload = false;             // the payload is a key, not a sample
};

// For Data, DataFrag, Heartbeat, HeartbeatFrag, Gap, AckNack and NackFrag. Nothing if the submessage is
// unsound: a length that does not fit, a number that cannot be, a range that no honest writer sends, entities
// of the wrong kind.
std::optional<Delivery> CheckDelivery(const Submessage &submessage);

}  // namespace Rabit::Rtps
