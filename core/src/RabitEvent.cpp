#include <rabit/RabitEvent.h>

#include "ExceptionText.h"

#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitLog.h>
#include <rabit/RabitManagerTrace.h>

#include <stdexcept>

namespace Rabit
{
namespace
{

using SlotList = std::vector<std::shared_ptr<Detail::EventSlot>>;

}  // namespace

namespace Detail
{

// Takes the slots that meet the condition out of the list and returns them. The returned list keeps the
// handlers alive until the lock is released.
template <typename Condition>
SlotList TakeSlots(EventState &event, Condition condition)
{
    std::shared_ptr<const SlotList> former;
    SlotList taken;
    const std::lock_guard<std::mutex> lock(*event.Mutex);
    if (!event.Slots)
    {
        return taken;
    }
    auto remaining = std::make_shared<SlotList>();
    for (const auto &slot : *event.Slots)
    {
        (condition(*slot) ? taken : *remaining).push_back(slot);
    }
    event.Count.store(static_cast<int>(remaining->size()), std::memory_order_release);
    former = std::move(event.Slots);
    event.Slots = remaining->empty() ? nullptr : std::move(remaining);
    return taken;
}

std::shared_ptr<EventState> EventSlot::Event() const
{
    const std::lock_guard<std::mutex> lock(_eventMutex);
    return _event.lock();
}

void EventSlot::SetEvent(const std::shared_ptr<EventState> &event)
{
    const std::lock_guard<std::mutex> lock(_eventMutex);
    _event = event;
}

template <typename Condition>
void RemoveSlots(EventState &event, Condition condition)
{
    for (const auto &slot : TakeSlots(event, condition))
    {
        slot->Connected.store(false, std::memory_order_release);
    }
}

// Read-modify-write of the count: see Fire.
static void AddSlots(EventState &event, const SlotList &added)
{
    std::shared_ptr<const SlotList> former;
    const std::lock_guard<std::mutex> lock(*event.Mutex);
    auto slots = event.Slots ? std::make_shared<SlotList>(*event.Slots) : std::make_shared<SlotList>();
    slots->insert(slots->end(), added.begin(), added.end());
    event.Count.exchange(static_cast<int>(slots->size()), std::memory_order_acq_rel);
    former = std::move(event.Slots);
    event.Slots = std::move(slots);
}

void CallHandler(const EventSlot &slot)
{
    try
    {
        slot.Handler();
    }
    catch (...)
    {
        RabitLog::Write(RabitLogLevel::Error, "an event handler threw: " + CurrentExceptionText());
    }
}

}  // namespace Detail

RabitQuickHandler::RabitQuickHandler(RabitHandler handler) : _handler(std::move(handler))
{
    if (!_handler)
    {
        throw std::invalid_argument("an empty handler cannot be connected to an event");
    }
}

void RabitConnection::Disconnect()
{
    const std::shared_ptr<Detail::EventSlot> slot = std::exchange(_slot, {}).lock();
    if (!slot || !slot->Connected.exchange(false))
    {
        return;
    }
    if (const std::shared_ptr<Detail::EventState> event = slot->Event())
    {
        Detail::RemoveSlots(*event, [&](const Detail::EventSlot &other) { return &other == slot.get(); });
    }
}

bool RabitConnection::IsConnected() const
{
    const std::shared_ptr<Detail::EventSlot> slot = _slot.lock();
    return slot && slot->Connected.load() && slot->Event() != nullptr;
}

RabitScopedConnection::RabitScopedConnection(RabitScopedConnection &&other) noexcept
    : _connection(std::exchange(other._connection, {}))
{
}

RabitScopedConnection &RabitScopedConnection::operator=(RabitScopedConnection &&other) noexcept
{
    if (this != &other)
    {
        _connection.Disconnect();
        _connection = std::exchange(other._connection, {});
    }
    return *this;
}

RabitEvent::RabitEvent() : RabitEvent(std::make_shared<std::mutex>()) {}

RabitEvent::RabitEvent(std::shared_ptr<std::mutex> mutex)
    : _state(std::make_shared<Detail::EventState>(std::move(mutex)))
{
}

RabitConnection RabitEvent::Connect(RabitHandler handler, const void *owner)
{
    if (!handler)
    {
        throw std::invalid_argument("an empty handler cannot be connected to an event");
    }
    const auto slot = std::make_shared<Detail::EventSlot>(std::move(handler), owner, _state);
    Detail::AddSlots(*_state, {slot});
    RabitConnection connection;
    connection._slot = slot;
    return connection;
}

void RabitEvent::DisconnectAllOf(const void *owner)
{
    Detail::RemoveSlots(
        *_state, [&](const Detail::EventSlot &slot) { return owner != nullptr && slot.Owner == owner; });
}

void RabitEvent::DisconnectAll()
{
    Detail::RemoveSlots(*_state, [](const Detail::EventSlot &) { return true; });
}

void RabitEvent::HandOverAllOf(const void *owner, RabitEvent &other)
{
    const SlotList slots = Detail::TakeSlots(
        *_state, [&](const Detail::EventSlot &slot) { return owner != nullptr && slot.Owner == owner; });
    if (slots.empty())
    {
        return;
    }
    for (const auto &slot : slots)
    {
        slot->SetEvent(other._state);
    }
    Detail::AddSlots(*other._state, slots);
    // A slot that was disconnected while it was in no list.
    Detail::RemoveSlots(*other._state, [](const Detail::EventSlot &slot) { return !slot.Connected.load(); });
}

void RabitEvent::DisownAllOf(const void *owner)
{
    const std::lock_guard<std::mutex> lock(*_state->Mutex);
    if (_state->Slots)
    {
        for (const auto &slot : *_state->Slots)
        {
            slot->Owner = (slot->Owner == owner) ? nullptr : slot->Owner;
        }
    }
}

void RabitEvent::Fire() const
{
    // A read-modify-write: either this sees a newly connected handler, or the thread that connects it sees
    // everything before this call.
    if (_state->Count.fetch_add(0, std::memory_order_acq_rel) == 0)
    {
        return;
    }
    Handlers handlers;
    {
        const std::lock_guard<std::mutex> lock(*_state->Mutex);
        handlers = Snapshot();
    }
    handlers.Call();
}

void RabitEvent::Handlers::CallAll() const
{
    const RabitManagerTrace::Pause pause;  // the manager's trace does not see handlers
    const RabitHandlerThread::Scope *const scope = RabitHandlerThread::Scope::Current();
    for (const auto &slot : *_slots)
    {
        if (slot->Connected.load(std::memory_order_acquire) &&
            (scope == nullptr || slot->IsQuick || !scope->HandOver(slot)))
        {
            Detail::CallHandler(*slot);
        }
    }
}

}  // namespace Rabit
