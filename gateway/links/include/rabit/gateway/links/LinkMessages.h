// What the queue links of two nodes say to each other: LinkData, LinkAck and LinkHello.
//
// They are views: names and payloads are borrowed from whoever made the object and are valid only during the
// call that hands it over, unless that says more (LinkOutput::Send). Nothing in them is trusted; LinkNode
// checks each one before it changes anything. Times are nanoseconds. A "clock" names the monotonic clock of
// one process by a random number.
#pragma once

#include <rabit/gateway/links/LinkPayload.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace Rabit
{

// First field of each message; others are dropped. Raised when the meaning of a field changes.
inline constexpr std::uint8_t LinkVersion = 2;

// Flags of one message in a LinkData.
inline constexpr std::uint8_t LinkFlagSkip = 1;  // expired at the sender: consume, do not deliver; no payload
inline constexpr std::uint8_t LinkFlagRedelivered =
    2;  // may have been delivered before the receiver restarted

// Value of LinkItem::TtlLeft for a message that never expires.
inline constexpr std::int64_t LinkNoExpiry = -1;

// Consumed messages whose outcome an acknowledgement carries, and the largest possible window.
inline constexpr std::size_t LinkOutcomeBits = 256;
using LinkBitmap = std::array<std::uint64_t, LinkOutcomeBits / 64>;

// Counters (the high half of an incarnation) above this are no reason to raise one's own: the wall clock's
// seconds reach it in 2097. Else one false message would take a node to the top, with no later life above it.
inline constexpr std::uint32_t LinkLargestClaim = 0xf0000000;

// Largest number of messages in one LinkData.
inline constexpr std::size_t LinkMaxItems = 256;

// Longest node, queue and type name in bytes.
inline constexpr std::size_t LinkMaxName = 255;

// The receiver's clock as the sender last heard of it, sent back to the receiver. It proves that this
// datagram was made after Time, and bounds how long it was on its way.
struct LinkEcho
{
    std::uint64_t Clock = 0;   // names the receiver's clock; never 0
    std::int64_t Time = 0;     // the receiver's reading when it sent this
    std::int64_t HeldFor = 0;  // how long ago it came, by the sender's clock
};

// One queue message.
struct LinkItem
{
    std::uint8_t Flags = 0;
    // What is left of its life when the datagram was made, 0 or more; LinkNoExpiry: it has no end.
    std::int64_t TtlLeft = LinkNoExpiry;
    std::string_view Type;                  // IDL name, for instance `Uav::Goto`; empty with LinkFlagSkip
    std::span<const std::uint8_t> Payload;  // the serialized message; empty with LinkFlagSkip
    // Whose bytes Payload are: who holds it may keep Payload. Null in what was received.
    LinkPayload Owner = nullptr;
};

// Some consecutive messages of one link, from the sender to the receiver.
struct LinkData
{
    std::uint8_t Version = LinkVersion;
    std::string_view Source;                // node that sends the messages
    std::string_view Destination;           // node that they are for
    std::string_view Queue;                 // its queue
    std::uint64_t SenderIncarnation = 0;    // s_inc: the life of the source that opened this stream
    std::uint64_t ReceiverIncarnation = 0;  // r_inc: the life of the destination that this is meant for
    std::uint64_t Base = 0;                 // first sequence number of this stream; at least 1
    std::uint64_t First = 0;                // sequence number of Items[0]; the others follow one by one
    LinkEcho Echo;
    std::int64_t SentAt = 0;      // the sender's clock; comes back in the acknowledgement
    std::vector<LinkItem> Items;  // 1 to LinkMaxItems
};

// What the receiver of a link has consumed and how much more it will take, from the receiver to the sender.
struct LinkAck
{
    std::uint8_t Version = LinkVersion;
    std::string_view Source;       // node that sends the messages of the link: where this goes
    std::string_view Destination;  // node that they are for: where this comes from
    std::string_view Queue;
    std::uint64_t ReceiverIncarnation = 0;  // r_inc: the life of the destination node now
    std::uint64_t SenderIncarnation = 0;    // s_inc of the open session; 0: there is none
    std::uint64_t Cumulative = 0;           // highest sequence number consumed; 0 without a session
    LinkBitmap Delivered{};                 // bit i: message Cumulative - i was put into the queue
    LinkBitmap Refused{};      // bit i: it could not be (no such queue, type not accepted, undecodable)
    std::uint32_t Credit = 0;  // messages after Cumulative that there is room for
    std::uint64_t Clock = 0;   // the token: the receiver's clock ...
    std::int64_t Time = 0;     // ... and its reading when this was sent
    std::uint64_t YourIncarnation = 0;  // highest life of the source node heard of
    // SentAt of the latest datagram of the session, and how long before this it came: so that the sender can
    // measure the round trip also of what it sent more than once (the timestamps of RFC 7323). 0: none came.
    std::int64_t EchoSentAt = 0;
    std::int64_t EchoHeldFor = 0;
};

// Says that a node is there and which life it is in; twice a second to each peer that answers.
struct LinkHello
{
    std::uint8_t Version = LinkVersion;
    std::string_view Source;
    std::string_view Destination;
    std::uint64_t Incarnation = 0;      // the life of the source now
    std::uint64_t YourIncarnation = 0;  // highest life of the destination heard of; 0: none yet
    std::uint64_t Clock = 0;            // the token, as in LinkAck
    std::int64_t Time = 0;
};

}  // namespace Rabit
