#pragma once

#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <string_view>

namespace Rabit
{

// How an accepted message ended. Each accepted message gets exactly one, unless its own process ends first.
enum class LinkOutcome : std::uint8_t
{
    Delivered,  // it was put into the remote queue
    Expired,    // its time ran out; it was not delivered and never will be
    InDoubt,  // the receiver (or this node) took a new incarnation before it was acknowledged: it may or may
              // not have been delivered
    RefusedThere  // the receiver could not put it into the queue (no such queue, type not accepted there,
                  // payload not decodable): it was not delivered and never will be
};

// Why a message was not accepted. Nothing changes when one is refused, except the counter that says so.
enum class LinkRefusal : std::uint8_t
{
    None,         // it was accepted
    FullByCount,  // the outbox holds LinkOptions::Capacity messages without an outcome
    FullByBytes,  // its payload and those without an outcome would exceed LinkOptions::CapacityBytes
    TooLarge,     // its payload alone exceeds LinkOptions::CapacityBytes
    BadName,  // the destination, queue or type name is empty or longer than LinkMaxName, or the destination
              // is this node
    TooManyPeers,  // LinkSettings::MaxPeers other nodes are known already, and none can be forgotten
    TooManyLinks   // LinkSettings::MaxLinksPerPeer links to this destination are in use already
};

// Result of LinkNode::Enqueue.
struct LinkEnqueued
{
    LinkRefusal Refusal = LinkRefusal::None;
    // Names the message in its outcome; rises by one for each message accepted by a LinkNode, from 1. 0:
    // refused.
    std::uint64_t Id = 0;
    // When Run has something to do for this peer: 0 if at once. As LinkNode::NextDue, without the other
    // peers.
    LinkTime Due = LinkNever;

    bool Accepted() const { return Refusal == LinkRefusal::None; }
};

// For logs: `delivered`, `expired`, `in doubt`, `refused there`; never empty.
std::string_view ToString(LinkOutcome outcome);
// For logs and counters, for instance `outbox full by count`; never empty.
std::string_view ToString(LinkRefusal refusal);

}  // namespace Rabit
