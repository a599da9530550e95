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
#include "queues/UnwantedSenders.h"

namespace Rabit
{

// The local queues into which other nodes may put messages, as the receivers of the links see them.
//
// Large messages are decoded while the links are not locked, since one of megabytes would hold up everybody
// else for as long as that takes: Deliver puts them off (LocalQueueResult::Later), TakeUndecoded gives them
// out, Decode makes messages of them, and Offer has Deliver take these when the links ask again.
//
// Threads: Decode on any; the rest under the lock of who drives the links.
class IncomingQueues final : public LocalQueues
{
public:
    using Queue = AcceptedQueue::Queue;

    // A payload up to this size is decoded while the links are locked: a few microseconds, and less than it
    // costs to put it off.
    static constexpr std::size_t QuicklyDecoded = 4096;

    // A message that was put off.
    struct Undecoded
    {
        std::string Source, Queue, Type;
        LinkPayload Owner;
        std::size_t Size = 0;  // the first bytes of Owner are the payload
    };
    struct Decoded
    {
        std::string_view Source, Queue;  // of the Undecoded
        std::size_t Size = 0;
        AcceptedQueue::Decoded What;
    };

    // A message that was put into a queue, for who records.
    struct Received
    {
        std::string Source, Queue, Type;
        LinkPayload Payload;
    };

    // `wake` is called when there is room in a queue that had none: on the thread of who took a message.
    IncomingQueues(const std::vector<AcceptRule> &rules, RabitWorkspace &workspace,
                   const std::function<void()> &wake, std::size_t quicklyDecoded = QuicklyDecoded,
                   bool keepsReceived = false);

    // Makes a message of what was put off, or says why there is none. Any thread.
    Decoded Decode(const Undecoded &message) const;
    // What Deliver may take in place of decoding, until Offer(nullptr).
    void Offer(const Decoded *message) { _offered = message; }
    // What was put off since the last call; into the empty list.
    void TakeUndecoded(std::vector<Undecoded> &messages) { messages.swap(_undecoded); }
    bool AnyUndecoded() const { return !_undecoded.empty(); }

    // Looks all queues up, and calls `changed` with the name of each that has come, gone, or has room again.
    void Find(const std::function<void(const std::string &queue)> &changed);
    // The queues that got messages since the last call, each once, are put into the empty list. Call
    // NotifyEnqueued of each when no lock is held.
    void TakeDelivered(std::vector<std::shared_ptr<Queue>> &queues) { queues.swap(_delivered); }
    bool AnyDelivered() const { return !_delivered.empty(); }

    // What was put into queues since the last call, if it is kept; into the empty list.
    void TakeReceived(std::vector<Received> &messages) { messages.swap(_received); }

    // LocalQueues
    LocalQueueResult Deliver(std::string_view source, std::string_view queue, std::string_view type,
                             std::span<const std::uint8_t> payload, const LinkPayload &owner,
                             bool redelivered) override;
    std::size_t Room(std::string_view queue) const override;

    // What keeps messages from being delivered, by queue, and who sends what is not accepted of it.
    std::vector<Gateway::Problem> Problems() const;

private:
    RabitWorkspace &_workspace;
    const std::size_t _quicklyDecoded;
    const bool _keepsReceived;
    std::map<std::string, AcceptedQueue, std::less<>> _accepted;  // the names: unchanged after construction
    const Decoded *_offered = nullptr;
    std::vector<Undecoded> _undecoded;
    std::vector<std::shared_ptr<Queue>> _delivered;
    std::vector<Received> _received;
    UnwantedSenders _unwanted;
};

}  // namespace Rabit
