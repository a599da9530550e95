#pragma once

#include <rabit/gateway/links/LinkTime.h>

#include <cstddef>
#include <cstdint>

namespace Rabit
{

// One link to another node, seen from the sender. The counters only rise.
// Accepted = Delivered + Expired + InDoubt + RefusedThere + Pending at any time.
struct LinkSenderCounters
{
    std::uint64_t Accepted = 0;
    std::uint64_t RefusedFullByCount = 0;  // Enqueue: LinkRefusal::FullByCount
    std::uint64_t RefusedFullByBytes = 0;  // Enqueue: LinkRefusal::FullByBytes
    std::uint64_t RefusedTooLarge = 0;     // Enqueue: LinkRefusal::TooLarge
    std::uint64_t Delivered = 0;
    std::uint64_t Expired = 0;
    std::uint64_t InDoubt = 0;
    std::uint64_t RefusedThere = 0;
    std::uint64_t PartsResent = 0;
    std::uint64_t BytesSent = 0;  // as on the air
    std::uint64_t Restarts = 0;   // times the stream was started anew (receiver's or own new incarnation)
    // Present state.
    std::size_t Pending = 0;         // messages without an outcome
    std::size_t PendingBytes = 0;    // bytes of their payloads
    double Fill = 0.0;               // of what LinkOptions lets wait, messages or bytes, the fuller; 1: full
    std::size_t Unacknowledged = 0;  // of them, sent at least once, as a whole or in part
    std::size_t UnacknowledgedParts = 0;
    bool HeldBack = false;  // the first of them waits: the receiver's queue is full, not there, or without
                            // memory for it
    LinkTime RoundTrip{0};  // of the path to the node, smoothed (RFC 6298 SRTT); 0: not measured yet
};

// One link from another node, seen from the receiver. The counters only rise.
struct LinkReceiverCounters
{
    std::uint64_t Delivered = 0;
    std::uint64_t Skipped = 0;             // consumed as expired
    std::uint64_t RefusedUnknown = 0;      // consumed, LocalQueueResult::Unknown
    std::uint64_t RefusedWrongType = 0;    // consumed, LocalQueueResult::WrongType
    std::uint64_t RefusedUndecodable = 0;  // consumed, LocalQueueResult::Undecodable
    std::uint64_t HeldBackFull = 0;        // not consumed: the local queue was full (rule R7)
    std::uint64_t HeldBackLate = 0;        // not consumed: too late by the echoed clock (rules R5 and R6)
    std::uint64_t HeldBackMemory = 0;      // not consumed: no memory for a piece of a large message
    std::uint64_t Duplicates = 0;          // parts consumed before (rule R4)
    std::uint64_t Kept = 0;                // parts that came before an earlier one, or wait for room
    std::uint64_t NotKept = 0;             // the same, but there was no memory for them
    std::uint64_t Stale = 0;               // frames that must not open a session (rule R3)
    std::uint64_t SessionsOpened = 0;
    std::uint64_t AcksSent = 0;
    // Present state.
    bool HeldBack = false;          // a message waits: the queue is full, or without memory for it
    std::size_t KeptBytes = 0;      // of parts that wait
    std::size_t AssemblyBytes = 0;  // of a large message that is coming in
};

// Counters of the node that belong to no single link. They only rise.
struct LinkNodeCounters
{
    std::uint64_t Malformed = 0;     // datagrams dropped because a field was impossible
    std::uint64_t OtherVersion = 0;  // datagrams dropped because they speak another version of the links
    std::uint64_t Stale = 0;         // datagrams for or from another incarnation (rules R1 and R2)
    std::uint64_t UnknownShort = 0;  // short frames whose check means nothing here
    std::uint64_t NotForUs = 0;      // datagrams dropped because another node was addressed
    std::uint64_t TooManyPeers = 0;  // datagrams dropped because of LinkSettings::MaxPeers
    std::uint64_t TooManyLinks = 0;  // datagrams dropped because of LinkSettings::MaxLinksPerPeer
    std::uint64_t NoSuchLink = 0;    // acknowledgements of links that this incarnation of the node does not
                                     // have
    std::uint64_t FalseClaims = 0;  // incarnations above LinkLargestClaim, of this node or unproved of a peer
    std::uint64_t RefusedUnknown = 0;  // messages for queues that this node does not accept
    std::uint64_t RefusedBadName = 0;  // Enqueue: LinkRefusal::BadName
    std::uint64_t RefusedTooMany = 0;  // Enqueue: LinkRefusal::TooManyPeers and TooManyLinks
    std::uint64_t Raises = 0;        // incarnations taken because a peer knew a higher one (rules R1 and S6)
    std::uint64_t RaisesPutOff = 0;  // messages of a higher one within LinkSettings::RaiseGap, ignored
    std::uint64_t Forgotten = 0;     // peers forgotten, with their links
    std::uint64_t PeerRestarts = 0;  // peers seen with a new incarnation
};

}  // namespace Rabit
