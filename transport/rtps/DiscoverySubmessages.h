// Reads and writes the submessages by which endpoints are announced (SEDP, OMG DDSI-RTPS 2.3, 8.5.4): between
// a DDS implementation and the cards, in both directions. Submessages that are read come from the own
// implementation, or from a card that was checked.
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

// The reader that belongs to a builtin writer, and the other way round (9.3.1.3: the last byte tells them
// apart).
EntityId ReaderOf(EntityId builtinWriter);
// Whether the writer announces endpoints.
bool IsEndpointWriter(EntityId writer);

// A heartbeat, a gap or an acknowledgement of such a writer, or an announcement of an endpoint or a fragment
// of one.
struct EndpointSubmessage
{
    SubmessageKind Kind = SubmessageKind::Pad;
    GuidPrefix To{};       // zero: all
    Delivery Said{};       // of an acknowledgement, First is the first number that is not acknowledged
    bool IsFinal = false;  // of a heartbeat or an acknowledgement: no answer is needed
    std::vector<std::int64_t> Gone{};       // of a gap: the numbers that will not come
    std::span<const std::uint8_t> Whole{};  // with its header; borrowed
};

// Nothing unless the datagram consists of such submessages alone.
std::optional<std::vector<EndpointSubmessage>> ReadEndpointSubmessages(
    std::span<const std::uint8_t> datagram);

// Reads an announcement in a card: a sample of discovery, alive or not. Nothing if it is none.
std::optional<Delivery> ReadAnnouncement(std::span<const std::uint8_t> submessage);
// The endpoint that an announcement, alive or not, is about; 0: it cannot be told.
EntityId SubjectOf(std::span<const std::uint8_t> announcement);
// Tells announcements of one endpoint apart; its number and the reader that it is for do not count.
std::uint64_t ContentOf(std::span<const std::uint8_t> announcement);

// Builds messages as if a participant had sent them. A header is the 20 bytes of one of its messages.
void AppendDestination(std::vector<std::uint8_t> &message, const GuidPrefix &to);
// The announcement under that number, for all readers.
void AppendAnnouncement(std::vector<std::uint8_t> &message, std::span<const std::uint8_t> announcement,
                        std::int64_t number);
void AppendHeartbeat(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t last,
                     std::uint32_t count);
// The numbers from `first` on and before `end` will not come.
void AppendGap(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t first, std::int64_t end);
// Acknowledges all before `base` and asks for the `missing`, which are within 256 from there.
void AppendAcknowledgement(std::vector<std::uint8_t> &message, EntityId writer, std::int64_t base,
                           std::span<const std::int64_t> missing, std::uint32_t count);
// The end of the participant whose header the message has.
void AppendEndOfParticipant(std::vector<std::uint8_t> &message, const GuidPrefix &participant,
                            std::int64_t number);

}  // namespace Rabit::Rtps
