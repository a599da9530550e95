#pragma once

#include <rabit/RabitQueueReceipt.h>
#include <rabit/gateway/Fleet.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// An observer, for recordings, of a gateway's queue messages, of mirrored samples, and of the other nodes'
// clocks. Set in GatewayConfig::Tap.
//
// Threads: called on any thread, on several at once, with no lock held; must be quick, since managers and the
// network wait for it. Views are valid during the call. Nothing may be thrown.
class GatewayTap
{
public:
    virtual ~GatewayTap() = default;

    struct QueueMessage
    {
        std::string_view Node;   // the other one; empty: a program that is no node (foreign topics)
        std::string_view Queue;  // the destination queue, here or there; of a foreign topic the local one
        std::string_view Type;   // IDL name
        // Identifies a sent message among all that this gateway sends; 0 if it was refused.
        std::uint64_t Id = 0;
        // As in a DDS sample, with its encapsulation header.
        std::span<const std::uint8_t> Sample;
    };
    // A message was accepted for another node, or for a foreign topic.
    virtual void Sent(const QueueMessage &message) = 0;
    // A message was not accepted, and why.
    virtual void Refused(const QueueMessage &message, std::string_view reason) = 0;
    // The outcome of an accepted message. May come before its Sent.
    virtual void Settled(std::string_view node, std::string_view queue, std::uint64_t id,
                         QueueOutcome outcome) = 0;
    // A message was put into a queue of this node.
    virtual void Received(const QueueMessage &message) = 0;

    struct MirroredSample
    {
        std::string_view Node;
        std::string_view Message;
        std::uint64_t Incarnation = 0;         // of the node
        std::int64_t SourceTime = 0;           // its post by the source clock of that incarnation, in ns
        std::chrono::nanoseconds PostedAt{0};  // the same by the monotonic clock here, as it is known
        std::span<const std::uint8_t> Sample;
    };
    // A message of another node was posted here. Never two at once of one message.
    virtual void Mirrored(const MirroredSample &sample) = 0;

    // Relates the source clock of another node, which its samples carry as source time, to this node's
    // monotonic clock.
    struct PeerClock
    {
        std::string Node;
        std::uint64_t Incarnation = 0;
        std::chrono::nanoseconds ToLocal{0};  // to be added to its source time
        // The round trip. ToLocal may be wrong by half of it. Empty: not known yet.
        std::optional<std::chrono::nanoseconds> RoundTrip;
    };
    // With each Gateway/Fleet, so once a second at least, on the gateway's thread. `sourceAhead` is to be
    // added to this node's monotonic clock to get its source clock.
    virtual void Clocks(std::uint64_t incarnation, std::chrono::nanoseconds sourceAhead,
                        const std::vector<PeerClock> &peers) = 0;
    // Returns the observer's own problems, to be shown in Gateway/Fleet. On the gateway's thread.
    virtual std::vector<Gateway::Problem> Problems() = 0;
};

}  // namespace Rabit
