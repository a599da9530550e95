#pragma once

#include <rabit/RabitClock.h>
#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitMessage.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/gateway/ForeignRule.h>
#include <rabit/gateway/GatewayTap.h>
#include <rabit/idl/MessageType.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "clocks/SourceClock.h"

namespace Rabit
{

// The messages of a local queue that wait to be written to a topic of foreign programs: each and every one,
// in order. A message is encoded when it is added, or refused at once: if it is of another type, or if the
// outbox is full. Refused messages are counted.
//
// The receipt of a message tells Delivered when the message was handed to DDS, Refused if it can never be
// sent, and Expired if it still waits at Close.
class ForeignOutbox
{
public:
    using Duration = std::chrono::nanoseconds;
    using Receipt = std::shared_ptr<RabitQueueReceipt>;

    // A refusal is a problem for this long, unless a message is accepted earlier.
    static constexpr Duration Memory = std::chrono::minutes(1);

    struct Message
    {
        std::vector<std::uint8_t> Sample;  // serialized
        std::int64_t SourceTime = 0;
        std::uint64_t Id = 0;
        Receipt Told{};  // may be null
    };
    // Called on the thread that adds a message, when it is the only one.
    using WakeUp = std::function<void()>;

    // The references and `handlers` must outlive the object. `handlers`, which may be null, calls the
    // handlers of receipts. The tap, which may be null, is told of all messages. `number` tells this outbox
    // from the others of the gateway.
    ForeignOutbox(const ForeignRule &rule, const MessageType &type, const RabitClock &clock,
                  const SourceClock &source, std::size_t number, WakeUp wake,
                  RabitHandlerThread *handlers = nullptr, std::shared_ptr<GatewayTap> tap = nullptr);

    // The name of the local queue.
    const std::string &Queue() const { return _rule.Local; }

    // Any thread. Returns false if the message is refused.
    bool Add(const RabitMessage &message, const Receipt &receipt);

    // The rest is for the gateway's thread. Returns the oldest message, valid until Pop; null if there is
    // none.
    const Message *Front() const;
    // Removes the oldest message, whose outcome is known. There must be one.
    void Pop(QueueOutcome outcome);
    // Returns the number of messages that were dropped. Later ones are refused.
    std::size_t Close();

    std::size_t Waiting() const;
    std::uint64_t Refused() const;
    // Why messages are refused; empty if none is.
    std::string Problem(Duration now) const;

private:
    // Returns false.
    bool Refuse(const Receipt &receipt, const std::string &reason);
    void TellRefused(std::string_view type, const std::vector<std::uint8_t> &sample,
                     const std::string &reason) const;

    const ForeignRule &_rule;
    const MessageType &_type;
    const RabitClock &_clock;
    const SourceClock &_source;
    const WakeUp _wake;
    RabitHandlerThread *const _handlers;
    const std::shared_ptr<GatewayTap> _tap;

    mutable std::mutex _mutex;  // guards all below
    std::deque<Message> _waiting;
    std::size_t _waitingBytes = 0;
    std::uint64_t _nextId;
    std::uint64_t _refused = 0;
    std::string _reason;  // of the last refusal; empty once a message was accepted
    Duration _refusedAt{0};
    bool _isClosed = false;
};

}  // namespace Rabit
