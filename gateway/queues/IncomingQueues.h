#pragma once

#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/links/LinkHost.h>
#include <rabit/gateway/links/LinkMessages.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway.idl.h"
#include "queues/AcceptedQueue.h"

namespace Rabit
{

// The local queues into which other nodes may put messages, as the receivers of the links see them.
//
// Large messages are decoded before the links are locked, since one of megabytes would hold up everybody else
// for as long as that takes: Decode makes them, Offer has Deliver take them from there.
//
// Threads: Decode on any; the rest under the lock of who drives the links.
class IncomingQueues final : public LocalQueues
{
public:
    using Queue = AcceptedQueue::Queue;

    // A message of a datagram, found again by where its payload lies.
    struct Decoded
    {
        const std::uint8_t *Payload = nullptr;
        AcceptedQueue::Decoded What;
    };
    using DecodedMessages = std::vector<Decoded>;

    // `wake` is called when there is room in a queue that had none: on the thread of who took a message.
    IncomingQueues(const std::vector<AcceptRule> &rules, RabitWorkspace &workspace,
                   const std::function<void()> &wake);

    // Appends the datagram's messages. Those for a queue that is not accepted are left out.
    void Decode(const LinkData &data, DecodedMessages &messages) const;
    // What Deliver is called for until Offer({}) is among these. In the order of the datagram.
    void Offer(std::span<const Decoded> messages);

    // Looks all queues up, and calls `changed` with the name of each that has come, gone, or has room again.
    void Find(const std::function<void(const std::string &queue)> &changed);
    // The queues that got messages since the last call, each once, are put into the empty list. Call
    // NotifyEnqueued of each when no lock is held.
    void TakeDelivered(std::vector<std::shared_ptr<Queue>> &queues) { queues.swap(_delivered); }
    bool AnyDelivered() const { return !_delivered.empty(); }

    // LocalQueues
    LocalQueueResult Deliver(std::string_view source, std::string_view queue, std::string_view type,
                             std::span<const std::uint8_t> payload, bool redelivered) override;
    std::size_t Room(std::string_view queue) const override;

    // What keeps messages from being delivered, by queue.
    std::vector<Gateway::Problem> Problems() const;

private:
    AcceptedQueue::Decoded TakeOffered(const AcceptedQueue &queue, std::string_view type,
                                       std::span<const std::uint8_t> payload);

    std::map<std::string, AcceptedQueue, std::less<>> _accepted;  // the names: unchanged after construction
    std::span<const Decoded> _offered;
    std::vector<std::shared_ptr<Queue>> _delivered;
};

}  // namespace Rabit
