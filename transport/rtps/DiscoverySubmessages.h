// Reads and writes the submessages that announce endpoints (SEDP, OMG DDSI-RTPS 2.3, 8.5.4), between a DDS
// implementation and the cards. Input is from the own implementation, or from a card that was checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "guard/DeliveryCheck.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// The reader that belongs to a builtin writer, and the reverse (9.3.1.3: they differ in the last byte).
EntityId ReaderOf(EntityId builtinWriter);
// True if the writer announces endpoints.
bool IsEndpointWriter(EntityId writer);

// A heartbeat, gap or acknowledgement of an endpoint writer, an announcement of an endpoint, or a fragment of
// one.
struct EndpointSubmessage
{
    SubmessageKind Kind = SubmessageKind::Pad;
    GuidPrefix To{};                   // zero: all
    Delivery Said{};                   // in an acknowledgement, First is the first number not acknowledged
    bool IsFinal = false;              // in a heartbeat or an acknowledgement: no answer is needed
    std::vector<std::int64_t> Gone{};  // in a gap: the numbers that will not come
    std::span<const std::uint8_t> Whole{};  // with its header; borrowed
};

// Empty unless the datagram consists of such submessages alone.
std::optional<std::vector<EndpointSubmessage>> ReadEndpointSubmessages(
    std::span<const std::uint8_t> datagram);

// Reads an announcement in a card: a sample of discovery, alive or not. Empty if it is none.
std::optional<Delivery> ReadAnnouncement(std::span<const std::uint8_t> submessage);
// The endpoint of an announcement, alive or not; 0: unknown.
EntityId SubjectOf(std::span<const std::uint8_t> announcement);
// Hash that tells announcements of one endpoint apart; ignores their number and reader.
std::uint64_t ContentOf(std::span<const std::uint8_t> announcement);

// The functions below build messages as if a participant had sent them. A header is the 20 bytes of one of
// its messages.
// Appends the announcement with that number, for all readers.
void AppendAnnouncement(std::vector<std::uint8_t> &message, std::span<const std::uint8_t> announcement,
                        std::int64_t number);
void AppendHeartbeat(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t last,
                     std::uint32_t count);
// Appends a gap: the numbers from `first` on and before `end` will not come.
void AppendGap(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t first, std::int64_t end);
// Acknowledges all before `base` and requests the `missing`, which are at most 256 numbers from there.
void AppendAcknowledgement(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t base,
                           std::span<const std::int64_t> missing, std::uint32_t count);
// Appends that an entity of the participant whose header the message has is gone: the participant itself,
// with ParticipantWriter and ParticipantEntity, or an endpoint, with the writer that announces it.
void AppendEnd(std::vector<std::uint8_t> &message, EntityId writer, const GuidPrefix &participant,
               EntityId entity, std::int64_t number);

}  // namespace Rabit::Rtps
