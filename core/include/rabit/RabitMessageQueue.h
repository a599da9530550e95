#pragma once

#include <rabit/RabitBoost.h>
#include <rabit/RabitEvent.h>
#include <rabit/RabitManagerTrace.h>
#include <rabit/RabitRing.h>
#include <rabit/SafeQueue.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace Rabit
{

// A named, bounded first-in-first-out queue for any number of threads: the receiver gets each and every
// message.
//
// Handlers run after the message was added (or taken), with no lock held, on the thread that added (or
// took) it or on its RabitHandlerThread. Their exceptions are caught and logged. For messages of other
// nodes they run on a thread of the gateway, and one call may stand for several messages. Elements are
// destroyed outside the lock.
template <typename T>
class RabitMessageQueue
{
public:
    typedef RabitBoostSlot _sigEnqueuSlotType;
    typedef T ElementType;

    static constexpr int MaxCapacity = 1000000;

    // The capacity is clamped to 1..MaxCapacity. An empty name becomes "MessageQueue".
    RabitMessageQueue(int maxNoMessages, std::string msgQName)
        : _name(msgQName.empty() ? "MessageQueue" : std::move(msgQName)),
          _ring(static_cast<std::size_t>(std::clamp(maxNoMessages, 1, MaxCapacity)))
    {
    }
    RabitMessageQueue(const RabitMessageQueue &) = delete;
    RabitMessageQueue &operator=(const RabitMessageQueue &) = delete;

    std::string GetMessageQueueName() { return _name; }
    const std::string &Name() const { return _name; }
    int GetMaxNoMessagesAllowedInQueue() { return static_cast<int>(_ring.Capacity()); }

    // Call the handler after each message that was added, or taken, for as long as the queue lives. Any
    // number of handlers. Throw std::invalid_argument if the handler is empty.
    void Register_SomethingEnqueued(const boost::function<void()> &handler)
    {
        ConnectSomethingEnqueued(handler);
    }
    void Register_SomethingDequeued(const boost::function<void()> &handler)
    {
        ConnectSomethingDequeued(handler);
    }
    // The same, with a connection that ends it.
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

    // Disconnects all handlers of messages added and taken. For an owner that is destroyed while others may
    // still hold the queue.
    void DisconnectAllHandlers()
    {
        _enqueued.DisconnectAll();
        _dequeued.DisconnectAll();
    }

    // Returns false when full, and then calls only the handlers of refused messages.
    bool AddMessage(T msg)
    {
        RabitEvent::Handlers handlers;
        bool added = false;
        {
            const std::lock_guard<std::mutex> lock(*_mutex);
            added = Push(msg);
            handlers = added ? _enqueued.Snapshot() : _refusal.Snapshot();
        }
        handlers.Call();
        return added;
    }

    // The same without calling handlers.
    bool AddMessageNoEventTrigger(T msg)
    {
        const std::lock_guard<std::mutex> lock(*_mutex);
        return Push(msg);
    }

    // Calls the handlers for messages that AddMessageNoEventTrigger added, for callers that must not run
    // handlers while they add.
    void NotifyEnqueued() { _enqueued.Fire(); }

    // Takes the oldest message. When empty, returns false, leaves the target unchanged and calls no
    // handler.
    bool GetMessage(T &msg)
    {
        std::optional<T> oldest;
        RabitEvent::Handlers handlers;
        {
            const std::lock_guard<std::mutex> lock(*_mutex);
            oldest = _ring.Pop();
            if (!oldest)
            {
                return false;
            }
            handlers = _dequeued.Snapshot();
        }
        msg = std::move(*oldest);
        handlers.Call();
        if constexpr (std::is_same_v<T, std::shared_ptr<RabitMessage>>)
        {
            if (RabitManagerTrace::Current() != nullptr && msg)
            {
                const RabitManagerTrace::Pause trace;
                trace->Taken(_name, *msg);
            }
        }
        return true;
    }

    // Destroys all messages. Calls no handlers.
    void ClearMessageQueue()
    {
        std::unique_lock<std::mutex> lock(*_mutex);
        const auto removed = _ring.TakeAll();
        lock.unlock();
    }

    int NoMessagesInQueue()
    {
        const std::lock_guard<std::mutex> lock(*_mutex);
        return static_cast<int>(_ring.Size());
    }

    bool IsEmpty() { return NoMessagesInQueue() == 0; }

    // The number of messages refused because the queue was full, since it was made.
    std::uint64_t GetNumberOfRefusedMessages()
    {
        const std::lock_guard<std::mutex> lock(*_mutex);
        return _refused;
    }

private:
    bool Push(T &msg)
    {
        const bool pushed = _ring.Push(msg);
        _refused += pushed ? 0 : 1;
        return pushed;
    }

    const std::string _name;
    // Guards the messages and the lists of handlers.
    const std::shared_ptr<std::mutex> _mutex = std::make_shared<std::mutex>();
    RabitRing<T> _ring;
    std::uint64_t _refused = 0;
    RabitEvent _enqueued{_mutex};
    RabitEvent _dequeued{_mutex};
    RabitEvent _refusal{_mutex};
};

}  // namespace Rabit
