#pragma once

#include <rabit/RabitBoost.h>
#include <rabit/RabitEvent.h>

#include <boost/lockfree/spsc_queue.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace Rabit
{

// A named, bounded, wait-free first-in-first-out queue for one producer thread and one consumer thread.
//
// AddMessage and AddMessageNoEventTrigger belong to the producer; GetMessage and ClearMessageQueue to the
// consumer; the rest may be called from any thread. T must be default-constructible and copyable. Handlers
// run as in RabitMessageQueue; when there are some, calling them takes a short lock on their list.
template <typename T>
class RabitNonBlockingSPSCQueue
{
public:
    typedef RabitBoostSlot _sigEnqueuSlotType;
    typedef T ElementType;

    static constexpr int MaxCapacity = 1000000;

    // Holds exactly maxNoMessages, clamped to 1..MaxCapacity. An empty name becomes "MessageQueue".
    RabitNonBlockingSPSCQueue(int maxNoMessages, std::string msgQName)
        : _name(msgQName.empty() ? "MessageQueue" : std::move(msgQName)),
          _capacity(std::clamp(maxNoMessages, 1, MaxCapacity)),
          _queue(static_cast<std::size_t>(_capacity))
    {
    }
    RabitNonBlockingSPSCQueue(const RabitNonBlockingSPSCQueue &) = delete;
    RabitNonBlockingSPSCQueue &operator=(const RabitNonBlockingSPSCQueue &) = delete;

    std::string GetMessageQueueName() { return _name; }
    int GetMaxNoMessagesAllowedInQueue() { return _capacity; }

    void Register_SomethingEnqueued(const boost::function<void()> &handler)
    {
        ConnectSomethingEnqueued(handler);
    }
    void Register_SomethingDequeued(const boost::function<void()> &handler)
    {
        ConnectSomethingDequeued(handler);
    }
    RabitConnection ConnectSomethingEnqueued(RabitHandler handler)
    {
        return _enqueued.Connect(std::move(handler));
    }
    RabitConnection ConnectSomethingDequeued(RabitHandler handler)
    {
        return _dequeued.Connect(std::move(handler));
    }
    // True if a handler is called for each message added.
    bool HasEnqueuedHandlers() const { return _enqueued.HasHandlers(); }
    // Calls the handler after each message that AddMessage refused because the queue was full.
    RabitConnection ConnectSomethingRefused(RabitHandler handler)
    {
        return _refusal.Connect(std::move(handler));
    }

    // Returns false when full, and then calls only the handlers of refused messages.
    bool AddMessage(T const &msg)
    {
        if (!AddMessageNoEventTrigger(msg))
        {
            _refusal.Fire();
            return false;
        }
        _enqueued.Fire();
        return true;
    }

    // The same without calling handlers.
    bool AddMessageNoEventTrigger(T const &msg)
    {
        const bool added = _queue.push(msg);
        Count(added ? _added : _refused);
        return added;
    }

    // Takes the oldest message. When empty, returns false, leaves the target unchanged and calls no
    // handler.
    bool GetMessage(T &msg)
    {
        if (!_queue.pop(msg))
        {
            return false;
        }
        Count(_taken);
        _dequeued.Fire();
        return true;
    }

    // Destroys all messages. Calls no handlers. For the consumer.
    void ClearMessageQueue()
    {
        _queue.consume_all([this](T &) { Count(_taken); });
    }

    // The number of messages that wait. From threads other than producer and consumer it may be slightly
    // out of date.
    int NoMessagesInQueue()
    {
        const std::uint64_t taken = _taken.load(std::memory_order_acquire);
        const std::uint64_t added = _added.load(std::memory_order_acquire);
        // The consumer may have counted a message that the producer has not counted yet.
        return added > taken ? static_cast<int>(std::min<std::uint64_t>(
                                   added - taken, static_cast<std::uint64_t>(_capacity)))
                             : 0;
    }
    bool IsEmpty() { return NoMessagesInQueue() == 0; }

    // The number of messages refused because the queue was full, since it was made.
    std::uint64_t GetNumberOfRefusedMessages() { return _refused.load(std::memory_order_relaxed); }

private:
    // Each counter has one writer.
    static void Count(std::atomic<std::uint64_t> &counter)
    {
        counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    }

    const std::string _name;
    const int _capacity;
    boost::lockfree::spsc_queue<T> _queue;
    std::atomic<std::uint64_t> _added{0};
    std::atomic<std::uint64_t> _taken{0};
    std::atomic<std::uint64_t> _refused{0};
    RabitEvent _enqueued;
    RabitEvent _dequeued;
    RabitEvent _refusal;
};

}  // namespace Rabit
