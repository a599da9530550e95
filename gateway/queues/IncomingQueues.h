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
#include "presence/RecentProblems.h"
#include "queues/AcceptedQueue.h"

namespace Rabit
{

// The local queues into which other nodes may put messages, as the receivers of the links see them.
//
// A large message is decoded while the links are not locked, since decoding megabytes would hold up all other
// messages. Deliver returns Later, TakeUndecoded gives the message out, and Decode makes the argument of
// LinkNode::Prepared.
//
// Threads: Decode on any; the rest under the lock of the links' driver.
class IncomingQueues final : public LocalQueues
{
public:
    using Queue = AcceptedQueue::Queue;

    // A payload up to this size is decoded while the links are locked: that takes a few microseconds, less
    // than to put it off.
    static constexpr std::size_t QuicklyDecoded = 4096;

    // A message that was put off; Type, SenderLife and Number as in LinkDelivery.
    struct Undecoded
    {
        std::string Source, Queue, Type;
        std::uint64_t SenderLife = 0;
        std::uint64_t Number = 0;
        LinkPayload Owner;
        std::size_t Size = 0;  // the first bytes of Owner are the payload
    };

    // A message that was put into a queue, for a recorder.
    struct Received
    {
        std::string Source, Queue, Type;  // the IDL name of its type
        LinkPayload Payload;
    };

    // `wake` is called when there is room in a queue that had none, on the thread that took a message.
    IncomingQueues(const std::vector<AcceptRule> &rules, RabitWorkspace &workspace,
                   const std::function<void()> &wake, std::size_t quicklyDecoded = QuicklyDecoded,
                   bool keepsReceived = false);

    // Returns LinkDelivery::Prepared of a message that was put off. Any thread.
    std::shared_ptr<void> Decode(const Undecoded &message) const;
    // Messages that were put off since the last call; into the empty list. The caller decodes them.
    void TakeUndecoded(std::vector<Undecoded> &messages) { messages.swap(_undecoded); }
    bool AnyUndecoded() const { return !_undecoded.empty(); }

    // Looks all queues up, and calls `changed` with the name of each that has come, gone, or has room again.
    void Find(const std::function<void(const std::string &queue)> &changed);
    // The queues that got messages since the last call, each once, are put into the empty list. Call
    // NotifyEnqueued of each when no lock is held.
    void TakeDelivered(std::vector<std::shared_ptr<Queue>> &queues) { queues.swap(_delivered); }
    bool AnyDelivered() const { return !_delivered.empty(); }

    // Moves the messages put into queues since the last call, if they are kept, into the empty list.
    void TakeReceived(std::vector<Received> &messages) { messages.swap(_received); }

    // LocalQueues
    bool Accepts(std::string_view source, std::string_view queue) override;
    bool AcceptsType(std::string_view queue, std::string_view type) const override;
    LocalQueueResult Deliver(const LinkDelivery &delivery) override;
    std::size_t Room(std::string_view queue) const override;

    // The problems of each queue that keep messages from being delivered, and the senders whose messages are
    // not accepted.
    std::vector<Gateway::Problem> Problems() const;

private:
    RabitWorkspace &_workspace;
    const std::size_t _quicklyDecoded;
    const bool _keepsReceived;
    std::map<std::string, AcceptedQueue, std::less<>> _accepted;  // the names: unchanged after construction
    std::vector<Undecoded> _undecoded;
    std::vector<std::shared_ptr<Queue>> _delivered;
    std::vector<Received> _received;
    RecentProblems _unwanted;  // senders without the right, by queue
};

}  // namespace Rabit
