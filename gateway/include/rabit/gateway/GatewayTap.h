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

// Is told what a gateway sends and receives for queues, and how the clocks of the others stand: for who
// records. Set in GatewayConfig::Tap. What mirrors carry is in the local messages.
//
// Threads: called on any, several at once, with no lock held; must be quick, since managers and the network
// wait for it. Views are valid during the call. Nothing may be thrown.
class GatewayTap
{
public:
    virtual ~GatewayTap() = default;

    struct QueueMessage
    {
        std::string_view Node;   // the other one
        std::string_view Queue;  // where the message is put, here or there
        std::string_view Type;   // IDL name
        // Of one that is sent: tells it from all others that this gateway sends; 0 for one that was refused.
        std::uint64_t Id = 0;
        // As in a DDS sample, with its encapsulation header.
        std::span<const std::uint8_t> Sample;
    };
    // Was accepted for another node.
    virtual void Sent(const QueueMessage &message) = 0;
    // Was not, and why.
    virtual void Refused(const QueueMessage &message, std::string_view reason) = 0;
    // What became of one that was accepted. May come before Sent of it.
    virtual void Settled(std::string_view node, std::string_view queue, std::uint64_t id,
                         QueueOutcome outcome) = 0;
    // Was put into a queue of this node.
    virtual void Received(const QueueMessage &message) = 0;

    // How the source clock of another node, which its samples carry as their source time, stands to the
    // monotonic clock of this one.
    struct PeerClock
    {
        std::string Node;
        std::uint64_t Incarnation = 0;
        std::chrono::nanoseconds ToLocal{0};  // to be added to its source time
        // There and back; half of it is how wrong that may be. Empty: not known yet.
        std::optional<std::chrono::nanoseconds> RoundTrip;
    };
    // With each Gateway/Fleet, so once a second at least, on the gateway's thread. `sourceAhead` is to be
    // added to this node's monotonic clock to get its source clock.
    virtual void Clocks(std::uint64_t incarnation, std::chrono::nanoseconds sourceAhead,
                        const std::vector<PeerClock> &peers) = 0;
    // What it finds wrong, to be shown in Gateway/Fleet. On the gateway's thread.
    virtual std::vector<Gateway::Problem> Problems() = 0;
};

}  // namespace Rabit
