#pragma once

#include <rabit/gateway/links/LinkTime.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace Rabit
{

// How the messages for one remote queue are treated. Fixed when the link is first used.
struct LinkOptions
{
    // Accepted messages without an outcome, at most; 1 or more.
    std::size_t Capacity = 1000;
    // Bytes of their payloads together, at most.
    std::size_t CapacityBytes = 16 * 1024 * 1024;
    // A message is not delivered later than this after it was enqueued; 0: messages do not expire.
    LinkTime Expire{0};
    // Messages sent, in whole or in part, and not acknowledged, at most; 1 to LinkMaxWindow. How many bytes
    // may be under way is decided by the path (PathControl), and common to all links to a node.
    std::size_t Window = 256;
    // Treatment of messages that were sent and not acknowledged when the receiver restarted. False: they are
    // in doubt. True: they are sent again, marked as redelivered, so that the queue gets each at least once.
    bool RedeliverInDoubt = false;
};

// Settings common to all links of a node. The defaults suit anything from a wire to a thin radio.
struct LinkSettings
{
    // Name of this node, 1 to LinkMaxName bytes.
    std::string Node;
    // A random number, not 0, drawn when the process starts: the name of its monotonic clock.
    std::uint64_t Clock = 0;
    // Largest encoded frame (LinkFrameCodec) in bytes; only names too long for it may exceed it. A larger
    // message is cut into parts.
    std::size_t MaxDatagram = 1312;
    // Bytes that a frame takes on the air beside its own: IPv4 20, UDP 8, RTPS 72, encapsulation and length
    // 8, padding 1.
    std::size_t AirOverhead = 109;
    // An acknowledgement waits for more to acknowledge: this long, or five quarters of the round trip, but
    // not longer than LongestAckDelay. It goes earlier if the sender asks, or if AckEvery parts or
    // AckEveryBytes of payload have come.
    LinkTime AckDelay{std::chrono::milliseconds(2)};
    LinkTime LongestAckDelay{std::chrono::milliseconds(250)};
    std::size_t AckEvery = 16;
    std::size_t AckEveryBytes = 128 * 1024;
    // The probe timer: its minimum, its value before the first measurement, and the limit of its backoff.
    LinkTime MinResend{std::chrono::milliseconds(5)};
    LinkTime FirstResend{std::chrono::milliseconds(200)};
    LinkTime MaxResend{std::chrono::seconds(1)};
    // Delay that a link may cause by what it has under way, beside the time that one datagram takes.
    LinkTime QueueingTarget{std::chrono::milliseconds(60)};
    // Bytes under way to one node at most, however short the round trip.
    std::size_t LargestWindow = 4 * 1024 * 1024;
    // The shortest round trip is measured anew when it was not seen for this long.
    LinkTime PathMemory{std::chrono::seconds(30)};
    // Bytes of parts that wait for earlier ones: of one link, and of all links of the node.
    std::size_t ReorderBytes = 1024 * 1024;
    std::size_t ReorderBytesOfNode = 16 * 1024 * 1024;
    // Bytes of a message in several parts at most, a larger one is refused; and of the beginnings of such
    // messages of all links, one of them not counted.
    std::size_t LargestMessage = 64 * 1024 * 1024;
    std::size_t AssemblyBytesOfNode = 64 * 1024 * 1024;
    // While messages wait for a peer's token, it is asked by hellos: at once, after twice HelloGap, then
    // after twice as long each time, up to HelloPeriod. A peer from which nothing came for SilentAfter
    // although something was asked of it is silent: it gets no messages, and is asked at SilentHelloPeriod
    // while messages wait. Hellos to one peer do not follow each other faster than HelloGap. While nothing
    // waits, nothing is sent.
    LinkTime HelloPeriod{std::chrono::milliseconds(250)};
    LinkTime SilentAfter{std::chrono::seconds(10)};
    LinkTime SilentHelloPeriod{std::chrono::seconds(2)};
    LinkTime HelloGap{std::chrono::milliseconds(20)};
    // Other nodes known, at most; links to one of them, and links from one of them, at most. When another one
    // comes, one for which nothing waits is forgotten: one without links, or else the one that has been
    // silent for longest.
    std::size_t MaxPeers = 1024;
    std::size_t MaxLinksPerPeer = 256;
    // Time between two new incarnations that this node takes because peers know of a higher one: each drops
    // all sessions, so one foolish peer must not ask for them one after the other.
    LinkTime RaiseGap{std::chrono::seconds(5)};
    // After this process has taken this many new incarnations, another live node is assumed to have the same
    // name. (A process takes one because its storage was lost.)
    std::uint32_t AlarmAfterRaises = 3;
};

}  // namespace Rabit
