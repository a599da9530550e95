#pragma once

#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkOutcome.h>
#include <rabit/gateway/links/LinkPayload.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace Rabit
{

// A message whose turn it is on a link. Names and Payload are borrowed for the call.
struct LinkDelivery
{
    std::string_view Source = {};
    std::string_view Queue = {};
    std::string_view Type = {};
    // The sender's incarnation and the number of the message's last part. The pair is unique among the
    // messages of a link.
    std::uint64_t SenderLife = 0;
    std::uint64_t Number = 0;
    std::span<const std::uint8_t> Payload = {};
    // Owns the bytes of Payload, which are its first bytes. Null: they are valid only during the call.
    LinkPayload Owner = nullptr;
    // An earlier incarnation of this node may have put the message into the queue already (only from links
    // with LinkOptions::RedeliverInDoubt).
    bool Redelivered = false;
    // Result of the driver's preparation of this very message (LinkNode::Prepared); null before that.
    std::shared_ptr<void> Prepared = nullptr;
};

// Outcome of LocalQueues::Deliver.
enum class LocalQueueResult : std::uint8_t
{
    Ok,    // the message is in the queue
    Full,  // not now: the link holds back the message, and all behind it, until there is room. Also the right
           // answer for a queue that is accepted but does not exist yet
    Later,    // the driver prepares the message elsewhere and then calls LinkNode::Prepared. Until that call
              // the link does not offer the message again
    Unknown,  // this node accepts no such queue
    WrongType,   // the queue does not accept this type, or the type is not known here
    Undecodable  // the payload is not a message of its type
};

// The local queues, as the receivers of the links see them. Called inside calls of LinkNode, on their thread;
// must not call LinkNode and must not throw.
class LocalQueues
{
public:
    // True if that node may send to that queue. A constant of each queue: a link to a queue that is not
    // accepted has no state here, and each of its messages is refused (LinkOutcome::RefusedThere).
    virtual bool Accepts(std::string_view source, std::string_view queue) = 0;
    // True if the accepted queue takes messages of that type, as the sender names it. A constant, too: names
    // of other types are not remembered.
    virtual bool AcceptsType(std::string_view queue, std::string_view type) const = 0;
    // Puts one message into an accepted queue, or returns why not. Full holds the link back; Unknown,
    // WrongType and Undecodable consume the message for good, and the sender learns
    // LinkOutcome::RefusedThere.
    virtual LocalQueueResult Deliver(const LinkDelivery &delivery) = 0;
    // Messages that the accepted queue would take now; a hint for the sender's window, not a promise.
    virtual std::size_t Room(std::string_view queue) const = 0;

protected:
    ~LocalQueues() = default;
};

// The output of the links to their driver. Called inside calls of LinkNode, on their thread; must not call
// LinkNode and must not throw. Sending may fail or lose the datagram: the links repair it.
class LinkOutput
{
public:
    // Sends to the gateway of the node frame.Destination. May be kept and encoded after the call: its source
    // and types are valid as long as the LinkNode, its payloads as long as their owners are held; its
    // destination and queue only until that node is forgotten, which may be soon: copy them. `queue`: that of
    // the frame's messages, which the frame itself need not name; empty: it has no messages.
    virtual void Send(const LinkFrame &frame, std::string_view queue) = 0;
    // True if acknowledgements for that node go in frames of their own, and not in those with messages: then
    // the driver may send them by another path as well.
    virtual bool SendsAcksAlone(std::string_view /*destination*/) const { return false; }
    // The options of a link that is made on first use, without LinkNode::Configure. They must be in range.
    virtual LinkOptions OptionsOf(std::string_view /*destination*/, std::string_view /*queue*/) const
    {
        return {};
    }
    // A message of that type ends as LinkOutcome::RefusedThere. OnOutcome follows.
    virtual void OnRefusedThere(std::string_view /*destination*/, std::string_view /*queue*/,
                                std::string_view /*type*/)
    {
    }
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
    // Returns an incarnation above `floor`. If there is a store, the incarnation must be safely stored before
    // anything is sent that LinkOutput was given after this. So no later incarnation of this node is below
    // one that others have heard. Called for the first incarnation (floor 0) and when a peer knows a higher
    // one.
    virtual std::uint64_t Above(std::uint64_t floor) = 0;

protected:
    ~IncarnationSource() = default;
};

}  // namespace Rabit
