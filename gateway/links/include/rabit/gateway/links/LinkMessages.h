// The messages between the queue links of two nodes: a LinkFrame, which may carry a LinkData and LinkAcks.
//
// They are views: names and payloads are borrowed from the maker of the object. They are valid only during
// the call that passes it, unless that call's comment says more (LinkOutput::Send). Nothing in them is
// trusted; LinkNode checks each one before it changes anything. Times are nanoseconds; on the wire,
// microseconds, rounded so that nothing seems younger than it is. A "clock" names the monotonic clock of one
// process by a random number.
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

// First byte of each frame; others are dropped. Raised when the meaning of anything changes.
inline constexpr std::uint8_t LinkVersion = 4;

// Flags of one part in a LinkData.
inline constexpr std::uint8_t LinkFlagSkip = 1;  // expired at the sender: consume, do not deliver; no payload
inline constexpr std::uint8_t LinkFlagRedelivered =
    2;                                            // may have been delivered before the receiver restarted
inline constexpr std::uint8_t LinkFlagFirst = 4;  // its message begins with it
inline constexpr std::uint8_t LinkFlagLast = 8;   // its message ends with it

// Value of LinkItem::TtlLeft for a message that never expires.
inline constexpr std::int64_t LinkNoExpiry = -1;

// Parts of one link that may be under way at once, and whose outcome an acknowledgement can carry.
inline constexpr std::size_t LinkWindowParts = 1024;
using LinkBitmap = std::array<std::uint64_t, LinkWindowParts / 64>;
// Largest number of messages of one link under way at once.
inline constexpr std::size_t LinkMaxWindow = 256;

// Largest counter (the high half of an incarnation) that is accepted without proof; the seconds of the wall
// clock reach it in 2097. A node does not raise its own incarnation above it because of a peer: one false
// frame could raise it to the top of the range, with no later incarnation above. A peer with a higher one
// must prove that it hears this node.
inline constexpr std::uint32_t LinkLargestClaim = 0xf0000000;

// Largest number of parts in one LinkData, and of acknowledgements in one LinkFrame.
inline constexpr std::size_t LinkMaxItems = 256;
inline constexpr std::size_t LinkMaxAcks = 32;

// Longest node, queue and type name in bytes.
inline constexpr std::size_t LinkMaxName = 255;
// Types that have a number on one link; further types are named in each message.
inline constexpr std::uint32_t LinkMaxTypes = 256;

// The newest reading of the receiver's clock that the sender got, sent back to the receiver. It proves that
// this frame was made after Time, bounds how long it was on its way, and measures the round trip.
struct LinkEcho
{
    std::uint32_t Clock = 0;   // names the receiver's clock; 0: none was heard
    std::int64_t Time = 0;     // the receiver's reading when it sent this
    std::int64_t HeldFor = 0;  // how long ago it came, by the sender's clock
};

// One part of a queue message: the whole of a small one, or a piece of a large one.
struct LinkItem
{
    std::uint64_t Sequence = 0;  // parts are numbered from 1 on
    std::uint64_t Through = 0;   // with LinkFlagSkip: the last number that is skipped; else as Sequence
    std::uint8_t Flags = 0;
    // In the last part: the message's time to live when the frame was made, 0 or more; LinkNoExpiry: it never
    // expires.
    std::int64_t TtlLeft = LinkNoExpiry;
    // In the first part: the type's number on this link, below LinkMaxTypes, and its name, which tells its
    // definition, too: the gateway's are as `Uav::Goto@0123456789abcdef`. The name may be left out once the
    // receiver knows the number. LinkMaxTypes: it has no number.
    std::uint32_t TypeNumber = 0;
    std::string_view Type;
    // In the first of several parts: bytes of the whole message.
    std::uint64_t Size = 0;
    std::span<const std::uint8_t> Payload;  // bytes of the serialized message; empty with LinkFlagSkip
    // Owner of the bytes of Payload, which are valid while it is held. Null in received frames.
    LinkPayload Owner = nullptr;
};

// Some parts of one link, from the sender to the receiver.
struct LinkData
{
    std::uint32_t Link = 0;  // the sender's number for the link, at least 1
    std::string_view Queue;  // of the receiver; may be left out once the receiver knows the number
    // No part below it is under way: their outcomes are known. A new stream begins with it. At least 1.
    std::uint64_t Oldest = 0;
    std::vector<LinkItem> Items;  // 1 to LinkMaxItems, with rising numbers
};

// From the receiver of a link to the sender: the parts that it has consumed, and how many more messages it
// accepts.
struct LinkAck
{
    std::uint32_t Link = 0;  // the sender's number for the link
    // True if there is a session with the sender's incarnation LinkFrame::ReceiverLife. If not, the rest is
    // zero, and the receiver does not know which queue the number means.
    bool Open = false;
    std::uint64_t Cumulative = 0;  // highest number consumed
    // Outcomes of the parts from Oldest to Cumulative, at most LinkWindowParts: the bit of part n is bit n
    // modulo LinkWindowParts. A message's outcome is that of its last part.
    std::uint64_t Oldest = 0;
    LinkBitmap Delivered{};    // it was put into the queue
    LinkBitmap Refused{};      // it could not be (no such queue, type not accepted, undecodable)
    LinkBitmap Held{};         // bit i: part Cumulative + 1 + i is here and waits for others
    std::uint32_t Credit = 0;  // messages after Cumulative that there is room for
};

// One datagram of the links. Without data and acknowledgements it is a hello: it says that a node is there,
// and its incarnation.
struct LinkFrame
{
    std::uint8_t Version = LinkVersion;
    std::string_view Source;       // not in the frame: the node that DDS reports as the writer
    std::string_view Destination;  // not in the frame, which has a 32-bit check of it
    // A short frame may be sent to a peer that knows both incarnations and both clocks. Its Check stands for
    // the destination, the incarnations and the clocks. Of each of the two times it has only the low 32 bits
    // of the microseconds.
    bool Short = false;
    std::uint32_t Check = 0;         // in a long frame: of the destination's name alone
    std::uint64_t SenderLife = 0;    // the present incarnation of the source
    std::uint64_t ReceiverLife = 0;  // highest known incarnation of the destination; 0: none yet
    std::uint32_t Clock = 0;         // the token: the sender's clock, never 0 ...
    std::int64_t Time = 0;           // ... and its reading when this was sent
    LinkEcho Echo;
    bool Ask = false;      // requests an immediate answer: an acknowledgement of the data, else a hello
    bool HasData = false;  // true if Data is valid
    LinkData Data;
    std::vector<LinkAck> Acks;

    bool IsHello() const { return !HasData && Acks.empty(); }
};

}  // namespace Rabit
