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
    // Messages sent and not acknowledged, at most; 1 to LinkOutcomeBits.
    std::size_t Window = 128;
    // Bytes of their payloads together, at most; a single larger message is sent alone. The second holds
    // while the window is used to the full and the round trip is not above LinkSettings::ShortRoundTrip; a
    // value below the first means the first.
    std::size_t WindowBytes = 256 * 1024;
    std::size_t LargestWindowBytes = 4 * 1024 * 1024;
    // What to do with messages that were sent and not acknowledged when the receiver restarted. False: they
    // are in doubt. True: they are sent again, marked as redelivered, so that the queue gets each at least
    // once.
    bool RedeliverInDoubt = false;
};

// What is common to all links of a node. The defaults suit a radio link of 10 to 500 ms round trip.
struct LinkSettings
{
    // Name of this node, 1 to LinkMaxName bytes.
    std::string Node;
    // A random number, not 0, drawn when the process starts: the name of its monotonic clock.
    std::uint64_t Clock = 0;
    // Bytes up to which messages that wait anyway share a LinkData, the names and numbers included. A message
    // that is larger by itself goes alone.
    std::size_t MaxDatagram = 1300;
    // An acknowledgement waits this long for more to acknowledge, unless AckEvery messages or AckEveryBytes
    // of payload were consumed: few large messages fill the sender's window, which then waits for it.
    LinkTime AckDelay{std::chrono::milliseconds(2)};
    std::size_t AckEvery = 16;
    std::size_t AckEveryBytes = 128 * 1024;
    // Bounds of the resend timer, and its value before the first measurement (RFC 6298, with bounds for our
    // links).
    LinkTime MinResend{std::chrono::milliseconds(20)};
    LinkTime FirstResend{std::chrono::milliseconds(200)};
    LinkTime MaxResend{std::chrono::seconds(1)};
    // Bytes per second that the slowest path is assumed to carry: what is on its way is sent again only after
    // the time that it needs at this rate, on top of the resend timer.
    std::size_t SlowPath = 512 * 1024;
    // A round trip up to this shows that nothing queues up on the way, so that more may be in flight.
    LinkTime ShortRoundTrip{std::chrono::milliseconds(10)};
    // A LinkHello goes to each peer at this period. A peer that was not heard for SilentAfter is silent: it
    // gets no messages, and hellos only while messages wait for it, at SilentHelloPeriod. Hellos to one peer
    // do not follow each other faster than HelloGap. While messages wait for the first token of a peer, the
    // first hellos come sooner, at twice HelloGap and each step twice the one before.
    LinkTime HelloPeriod{std::chrono::milliseconds(500)};
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
    // New incarnations that this process may have to take (its storage was lost) before it must be assumed
    // that another live node has the same name.
    std::uint32_t AlarmAfterRaises = 3;
};

}  // namespace Rabit
