#pragma once

#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkOutcome.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace Rabit
{

// What became of a message that the receiver wanted to put into a local queue.
enum class LocalQueueResult : std::uint8_t
{
    Ok,    // it is in the queue
    Full,  // not now: the sender holds it (and all behind it) back until there is room. Also the right answer
           // for a queue that is accepted but does not exist yet
    Later,       // the same, but who drives the links is about to ask again, by LinkNode::Retry
    Unknown,     // this node accepts no such queue
    WrongType,   // the queue does not accept this type, or the type is not known here
    Undecodable  // the payload is not a message of its type
};

// The local queues, as the receivers of the links see them. Called inside calls of LinkNode, on their thread;
// must not call LinkNode and must not throw.
class LocalQueues
{
public:
    // Puts one message into a local queue, or says why not. Names and payload are borrowed for the call;
    // `owner` is whose bytes the payload are the first of, null if nobody's who can be held. Full holds the
    // link back; Unknown, WrongType and Undecodable consume the message for good, and the sender learns of it
    // as LinkOutcome::RefusedThere. `redelivered`: an earlier life of this node may have put it into the
    // queue already (only from links with LinkOptions::RedeliverInDoubt).
    virtual LocalQueueResult Deliver(std::string_view source, std::string_view queue, std::string_view type,
                                     std::span<const std::uint8_t> payload, const LinkPayload &owner,
                                     bool redelivered) = 0;
    // Messages that the queue would take now; a hint for the sender's window, not a promise. For a queue that
    // this node does not accept: anything above 0, so that the messages come and are refused.
    virtual std::size_t Room(std::string_view queue) const = 0;

protected:
    ~LocalQueues() = default;
};

// What the links tell their driver. Called inside calls of LinkNode, on their thread; must not call LinkNode
// and must not throw. Sending may fail or lose the datagram: the links repair it.
class LinkOutput
{
public:
    // Sends to the gateway of the node frame.Destination. May be kept and encoded after the call: its source
    // and types are valid as long as the LinkNode, its payloads as long as their owners are held; its
    // destination and queue only until that node is forgotten, which may be soon: copy them.
    virtual void Send(const LinkFrame &frame) = 0;
    // The outcome of an accepted message is known.
    virtual void OnOutcome(std::uint64_t id, std::string_view destination, std::string_view queue,
                           LinkOutcome outcome) = 0;

protected:
    ~LinkOutput() = default;
};

// Makes incarnations. The gateway's IncarnationStore is the real one. Called inside calls of LinkNode.
class IncarnationSource
{
public:
    // Returns an incarnation above `floor`. If there is a store, it must be safely stored before anything is
    // sent that LinkOutput was given after this, so that no later life of this node starts below what others
    // have heard. Called for the first incarnation (floor 0) and when a peer knows a higher one.
    virtual std::uint64_t Above(std::uint64_t floor) = 0;

protected:
    ~IncarnationSource() = default;
};

}  // namespace Rabit
