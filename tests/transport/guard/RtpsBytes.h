// RTPS messages for tests, byte by byte.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "guard/RtpsMessage.h"

namespace RtpsBytes
{

using Bytes = std::vector<std::uint8_t>;
using Rabit::Rtps::EntityId;
using Rabit::Rtps::GuidPrefix;

constexpr std::uint8_t AckNack = 0x06;
constexpr std::uint8_t Heartbeat = 0x07;
constexpr std::uint8_t Gap = 0x08;
constexpr std::uint8_t InfoTimestamp = 0x09;
constexpr std::uint8_t InfoSource = 0x0c;
constexpr std::uint8_t InfoDestination = 0x0e;
constexpr std::uint8_t InfoReply = 0x0f;
constexpr std::uint8_t NackFrag = 0x12;
constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t DataFrag = 0x16;
constexpr std::uint8_t SecurePrefix = 0x31;
constexpr std::uint8_t Statistics = 0x80;

constexpr EntityId UserWriter = 0x00000103;
constexpr EntityId UserReader = 0x00000104;
inline constexpr GuidPrefix Sender = {1, 15, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
// The address that ParticipantData announces.
inline constexpr Rabit::Rtps::HostAddress SenderHost = {127, 0, 0, 1};
inline constexpr GuidPrefix Other = {1, 15, 3, 4, 5, 6, 7, 8, 9, 10, 11, 99};

Bytes Join(std::initializer_list<Bytes> parts);
Bytes U16(std::uint16_t value);
Bytes U32(std::uint32_t value);
Bytes Entity(EntityId entity);
Bytes Sequence(std::int64_t number);
// The bits of a number set, all clear.
Bytes Bits(std::uint32_t count);
Bytes Guid(const GuidPrefix &prefix, EntityId entity);

Bytes Header(const GuidPrefix &sender = Sender);
// Little-endian, like everything here.
Bytes Submessage(std::uint8_t kind, const Bytes &body, std::uint8_t flags = 1);
// INFO_SRC: names the sender of the submessages that follow.
Bytes Source(const GuidPrefix &sender);
// A message of one submessage.
Bytes Message(std::uint8_t kind, const Bytes &body, std::uint8_t flags = 1);

// Bodies of submessages.
Bytes Ids(EntityId reader = 0, EntityId writer = UserWriter);
Bytes DataBody(std::int64_t sequence, const Bytes &rest = {0, 1, 0, 0, 7, 0, 0, 0},
               EntityId writer = UserWriter, EntityId reader = 0);
Bytes FragmentBody(std::uint32_t first, std::uint16_t count, std::uint16_t size, std::uint32_t whole,
                   std::size_t bytes, EntityId writer = UserWriter);
Bytes HeartbeatBody(std::int64_t first, std::int64_t last, std::uint32_t count, EntityId writer = UserWriter);
Bytes GapBody(std::int64_t start, std::int64_t base, std::uint32_t bits = 0, EntityId writer = UserWriter);
Bytes AckNackBody(std::int64_t base, std::uint32_t bits, std::uint32_t count, EntityId writer = UserWriter);
Bytes NackFragBody(std::int64_t sequence, std::uint32_t base, std::uint32_t bits, std::uint32_t count);

// Parameters of discovery, and lists of them with the sentinel at the end.
Bytes Parameter(std::uint16_t id, const Bytes &value);
Bytes Text(const char *text);
Bytes List(std::initializer_list<Bytes> parameters);
// The announcements of a participant and of a writer.
Bytes ParticipantData(const GuidPrefix &of = Sender, std::uint32_t port = 7410);
Bytes WriterData(EntityId writer = UserWriter, const GuidPrefix &of = Sender);
// Messages with these announcements.
Bytes ParticipantMessage(const GuidPrefix &sender = Sender, std::uint32_t port = 7410);
Bytes WriterMessage(EntityId writer = UserWriter, std::int64_t sequence = 1,
                    const GuidPrefix &sender = Sender);

}  // namespace RtpsBytes
