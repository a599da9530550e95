#pragma once

#include <rabit/RabitQueueReceipt.h>
#include <rabit/gateway/links/LinkPayload.h>
#include <rabit/idl/MessageType.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace Rabit
{

// Messages for nodes that have sent queue messages, and whose announcement has not arrived: replies to the
// first requests of a new node. They wait for the announcement, in order. Thread-safe; no function is called
// with the lock held, but for `knows`.
class EarlyMessages
{
public:
    using Duration = std::chrono::nanoseconds;
    // True if the node has announced itself.
    using Knows = std::function<bool(const std::string &node)>;

    // 10 s: an announcement takes one or two beat periods, of 0.5 s unless the channel is thin.
    static constexpr Duration LongestWait = std::chrono::seconds(10);
    // Of all nodes together: as much as one link holds.
    static constexpr std::size_t MostMessages = 1000;
    static constexpr std::size_t MostBytes = 16 * 1024 * 1024;

    struct Message
    {
        std::string Node, Queue;
        const MessageType *Type = nullptr;
        LinkPayload Payload;
        std::shared_ptr<RabitQueueReceipt> Receipt;
        Duration Since{0};  // when it was accepted
    };
    enum class Added
    {
        Waits,
        TooMany,
        NotNeeded  // the node has announced itself, and nothing waits for it
    };

    // `knows` is asked under the lock: an announcement that comes at this moment is not missed.
    Added Add(Message message, const Knows &knows);
    bool IsEmpty() const { return _messages == 0; }
    // Takes out, one by one, the messages for nodes that have announced themselves, and those that waited for
    // LongestWait. Messages that are added meanwhile wait behind them. One thread at a time.
    void Release(Duration now, const Knows &knows, const std::function<void(const Message &)> &take);
    // The same for all messages for that node; without a node, for all.
    void ReleaseAll(const std::function<void(const Message &)> &take, const std::string &node = "");
    // Calls the function for each message that waits, under the lock.
    void Visit(const std::function<void(const Message &)> &visit) const;

private:
    std::vector<std::string> Nodes() const;
    // Takes out the first message for the node, if there is one and `isDue` holds for it.
    void ReleaseOf(const std::string &node, const std::function<bool(const Message &)> &isDue,
                   const std::function<void(const Message &)> &take);

    mutable std::mutex _mutex;
    std::map<std::string, std::deque<Message>> _waiting;  // by node; an entry lasts until all of it is taken
    std::size_t _bytes = 0;
    std::atomic<std::size_t> _messages{0};  // changed with the mutex held
};

}  // namespace Rabit
