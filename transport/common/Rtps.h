// The parts of an RTPS message (OMG DDSI-RTPS 2.3, 8.3 and 9.4), by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace Rabit::Rtps
{

constexpr std::size_t RtpsHeaderSize = 20;
constexpr std::size_t SubmessageHeaderSize = 4;
constexpr std::size_t EncapsulationSize = 4;  // in front of a payload
constexpr std::size_t SequenceSize = 8;       // of a sequence number
// Offset of the sender's prefix in a header, and of the source's in the body of an INFO_SRC.
constexpr std::size_t PrefixAt = 8;
// Offsets in the body of a DATA or DATA_FRAG, behind the extra flags and octetsToInlineQos. In all other
// submessages of writers and readers the reader comes first.
constexpr std::size_t ReaderInData = 4;
constexpr std::size_t WriterInData = 8;
constexpr std::size_t NumberInData = 12;

using GuidPrefix = std::array<std::uint8_t, 12>;
// IPv4 address in reading order: 10.0.0.1 begins with 10.
using HostAddress = std::array<std::uint8_t, 4>;
constexpr HostAddress UnknownHost{};

// Its four bytes as one big-endian number: 0x000100c2 writes the announcements of participants.
using EntityId = std::uint32_t;
constexpr EntityId ParticipantEntity = 0x000001c1;
// Entities of discovery and liveliness (9.3.1.3) that we use.
constexpr EntityId ParticipantWriter = 0x000100c2;
constexpr EntityId PublicationsWriter = 0x000003c2;
constexpr EntityId SubscriptionsWriter = 0x000004c2;
constexpr EntityId LivelinessWriter = 0x000200c2;

// True if the entity is a builtin one of the protocol (9.3.1.2).
constexpr bool IsBuiltin(EntityId entity)
{
    return (entity & 0xc0) == 0xc0;
}

// 9.4.5.1.1; those from 0x80 on are the vendors' own.
enum class SubmessageKind : std::uint8_t
{
    Pad = 0x01,
    AckNack = 0x06,
    Heartbeat = 0x07,
    Gap = 0x08,
    InfoTimestamp = 0x09,
    InfoSource = 0x0c,
    InfoDestination = 0x0e,
    NackFrag = 0x12,
    HeartbeatFrag = 0x13,
    Data = 0x15,
    DataFrag = 0x16,
    // Fast DDS's own, at the end of each message that it sends.
    Statistics = 0x80
};

// Flags of submessages (9.4.5).
constexpr std::uint8_t LittleEndianFlag = 0x01;
constexpr std::uint8_t FinalFlag = 0x02;       // HEARTBEAT, ACKNACK: no answer is needed
constexpr std::uint8_t InvalidateFlag = 0x02;  // INFO_TS: no time follows
constexpr std::uint8_t InlineQosFlag = 0x02;   // DATA, DATA_FRAG
constexpr std::uint8_t DataFlag = 0x04;        // DATA: the payload is a sample
constexpr std::uint8_t KeyFlag = 0x08;         // DATA: the payload is a key

// True for Data, DataFrag, Heartbeat, HeartbeatFrag, Gap, AckNack and NackFrag.
constexpr bool IsDelivery(SubmessageKind kind)
{
    const auto number = static_cast<std::uint8_t>(kind);
    return (number >= 0x06 && number <= 0x08) || kind == SubmessageKind::NackFrag ||
           kind == SubmessageKind::HeartbeatFrag || kind == SubmessageKind::Data ||
           kind == SubmessageKind::DataFrag;
}

// Parameters (9.6.3); the last ones are vendor-specific.
namespace Parameters
{
enum : std::uint16_t
{
    Pad = 0x0000,
    Sentinel = 0x0001,
    LeaseDuration = 0x0002,
    TimeBasedFilter = 0x0004,
    TopicName = 0x0005,
    OwnershipStrength = 0x0006,
    TypeName = 0x0007,
    ProtocolVersion = 0x0015,
    VendorId = 0x0016,
    Reliability = 0x001a,
    Liveliness = 0x001b,
    Durability = 0x001d,
    DurabilityService = 0x001e,
    Ownership = 0x001f,
    Presentation = 0x0021,
    Deadline = 0x0023,
    DestinationOrder = 0x0025,
    LatencyBudget = 0x0027,
    Partition = 0x0029,
    Lifespan = 0x002b,
    UserData = 0x002c,
    GroupData = 0x002d,
    TopicData = 0x002e,
    UnicastLocator = 0x002f,
    MulticastLocator = 0x0030,
    DefaultUnicastLocator = 0x0031,
    MetatrafficUnicastLocator = 0x0032,
    MetatrafficMulticastLocator = 0x0033,
    ExpectsInlineQos = 0x0043,
    DefaultMulticastLocator = 0x0048,
    ParticipantGuid = 0x0050,
    BuiltinEndpointSet = 0x0058,
    PropertyList = 0x0059,
    EndpointGuid = 0x005a,
    EntityName = 0x0062,
    KeyHash = 0x0070,
    StatusInfo = 0x0071,
    DataRepresentation = 0x0073,
    DisablePositiveAcks = 0x8005,
    RelatedSample = 0x800f
};
}  // namespace Parameters

}  // namespace Rabit::Rtps
