#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace Rabit
{

// A function that is called when an event fires.
using RabitHandler = std::function<void()>;

// Marks a handler that never waits for anything and takes microseconds, such as one that wakes a manager:
// it is always called on the thread that fires. Handlers without the mark may be called elsewhere
// (RabitHandlerThread). Converts to a RabitHandler; a boost::function made of it loses the mark.
class RabitQuickHandler
{
public:
    // Throws std::invalid_argument if the handler is empty.
    explicit RabitQuickHandler(RabitHandler handler);
    void operator()() const { _handler(); }

private:
    RabitHandler _handler;
};

namespace Detail
{
struct EventSlot;
struct EventState;
}  // namespace Detail

// A handler's connection to an event. Copies stand for the same connection; destroying them does not end
// it. Thread-safe like a shared pointer: one object belongs to one thread at a time.
class RabitConnection
{
public:
    RabitConnection() = default;

    // After this the handler is not called again, but a call that another thread has begun may still be
    // running. A handler must therefore share ownership of what it uses, unless the caller knows that no
    // call is running. Does nothing if already disconnected or if the event is gone. May be called from
    // inside the handler.
    void Disconnect();
    bool IsConnected() const;

private:
    friend class RabitEvent;
    std::weak_ptr<Detail::EventSlot> _slot;
};

// A connection that ends with its scope.
class RabitScopedConnection
{
public:
    RabitScopedConnection() = default;
    RabitScopedConnection(RabitConnection connection) : _connection(std::move(connection)) {}
    RabitScopedConnection(RabitScopedConnection &&other) noexcept;
    RabitScopedConnection &operator=(RabitScopedConnection &&other) noexcept;
    ~RabitScopedConnection() { _connection.Disconnect(); }

    void Disconnect() { _connection.Disconnect(); }
    bool IsConnected() const { return _connection.IsConnected(); }

private:
    RabitConnection _connection;
};

// A list of handlers that are called whenever the event fires.
//
// Handlers run on the thread that fires, in the order of their connection, with no lock held: they may
// connect, disconnect, post and fire. Exceptions of a handler are caught and logged, and the other handlers
// still run. All methods may be called from any thread. A thread that must not block hands all handlers
// except RabitQuickHandlers over to another thread (RabitHandlerThread).
class RabitEvent
{
public:
    // The handlers that were connected at one moment.
    class Handlers
    {
    public:
        // Calls them all. No lock may be held.
        void Call() const
        {
            if (_slots)
            {
                CallAll();
            }
        }

    private:
        friend class RabitEvent;
        void CallAll() const;
        std::shared_ptr<const std::vector<std::shared_ptr<Detail::EventSlot>>> _slots;
    };

    RabitEvent();
    // An event whose list of handlers is guarded by the owner's mutex: the owner can then change its own
    // state and take the snapshot of handlers in one step (Snapshot).
    explicit RabitEvent(std::shared_ptr<std::mutex> mutex);
    RabitEvent(const RabitEvent &) = delete;
    RabitEvent &operator=(const RabitEvent &) = delete;

    // Throws std::invalid_argument if the handler is empty. The owner is a mark for DisconnectAllOf.
    RabitConnection Connect(RabitHandler handler, const void *owner = nullptr);
    // DisconnectAllOf disconnects the handlers with that mark (not null), DisconnectAll all; DisownAllOf
    // takes the mark off them.
    void DisconnectAllOf(const void *owner);
    void DisconnectAll();
    void DisownAllOf(const void *owner);
    // Moves the handlers with that mark (not null) to the other event, behind its own handlers. Their
    // RabitConnections are then connections to the other event.
    void HandOverAllOf(const void *owner, RabitEvent &other);
    // Tells all handlers. Takes no lock if there are none.
    void Fire() const;
    bool HasHandlers() const;
    // The handlers connected now. The caller holds the mutex that was given to the constructor.
    Handlers Snapshot() const;

private:
    std::shared_ptr<Detail::EventState> _state;
};

namespace Detail
{

struct EventSlot
{
    EventSlot(RabitHandler handler, const void *owner, const std::shared_ptr<EventState> &event)
        : Handler(std::move(handler)),
          IsQuick(Handler.target<RabitQuickHandler>() != nullptr),
          Owner(owner),
          _event(event)
    {
    }
    // The event that has the slot in its list, or is to get it (HandOverAllOf); null if that event is gone.
    std::shared_ptr<EventState> Event() const;
    void SetEvent(const std::shared_ptr<EventState> &event);

    const RabitHandler Handler;
    const bool IsQuick;
    const void *Owner;  // guarded by the event's mutex
    std::atomic<bool> Connected{true};
    std::atomic<bool> Waits{false};  // handed over to a RabitHandlerThread, and not called yet

private:
    mutable std::mutex _eventMutex;
    std::weak_ptr<EventState> _event;
};

// Logs what the handler throws.
void CallHandler(const EventSlot &slot);

struct EventState
{
    explicit EventState(std::shared_ptr<std::mutex> mutex) : Mutex(std::move(mutex)) {}
    std::shared_ptr<std::mutex> Mutex;
    // Replaced as a whole under the mutex, never changed: a snapshot of it stays valid without a lock.
    std::shared_ptr<const std::vector<std::shared_ptr<EventSlot>>> Slots;
    std::atomic<int> Count{0};
};

}  // namespace Detail

inline bool RabitEvent::HasHandlers() const
{
    return _state->Count.load(std::memory_order_acquire) > 0;
}

inline RabitEvent::Handlers RabitEvent::Snapshot() const
{
    Handlers handlers;
    handlers._slots = _state->Slots;
    return handlers;
}

}  // namespace Rabit
