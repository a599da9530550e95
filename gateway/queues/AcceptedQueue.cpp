#include "queues/AcceptedQueue.h"

#include <rabit/gateway/NamePattern.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <typeinfo>
#include <utility>

#include "names/TypeDefinition.h"

namespace Rabit
{

AcceptedQueue::AcceptedQueue(const AcceptRule &rule, RabitWorkspace &workspace, std::function<void()> wake)
    : _rule(rule), _workspace(workspace), _gate(std::make_shared<Gate>())
{
    _gate->Wake = std::move(wake);
    for (const std::string &name : rule.Types)
    {
        if (const MessageType *const type = MessageTypeRegistry::Find(name))
        {
            _types[LinkTypeName(*type)] = type;
        }
    }
}

bool AcceptedQueue::Find()
{
    const std::shared_ptr<RabitQueueHandle> handle = _workspace.FindQueue(_rule.Queue);
    _wrongKind = handle && handle->QueueType() != typeid(Queue);
    const std::shared_ptr<Queue> queue =
        handle && !_wrongKind ? std::static_pointer_cast<Queue>(handle->Queue()) : nullptr;
    _handle = handle;
    if (queue == _queue)
    {
        return false;
    }
    _queue = queue;
    _popped.Disconnect();
    if (_queue)
    {
        _popped = _queue->ConnectSomethingDequeued(
            [gate = _gate]
            {
                if (gate->Full.exchange(false))
                {
                    gate->RoomCame = true;
                    gate->Wake();
                }
            });
    }
    return true;
}

std::string AcceptedQueue::Problem() const
{
    if (_wrongKind)
    {
        return "the local queue `" + _rule.Queue + "` does not hold std::shared_ptr<RabitMessage>";
    }
    return _queue ? "" : "there is no local queue `" + _rule.Queue + "`";
}

bool AcceptedQueue::AcceptsFrom(std::string_view node) const
{
    return MatchesAny(_rule.From, node);
}

AcceptedQueue::Decoded AcceptedQueue::Decode(std::string_view typeName,
                                             std::span<const std::uint8_t> payload) const
{
    const auto type = _types.find(typeName);
    if (type == _types.end())
    {
        return {LocalQueueResult::WrongType, nullptr};
    }
    std::shared_ptr<RabitMessage> message = type->second->CreateShared();
    if (!type->second->Deserialize(payload, *message))
    {
        return {LocalQueueResult::Undecodable, nullptr};
    }
    return {LocalQueueResult::Ok, std::move(message)};
}

LocalQueueResult AcceptedQueue::Deliver(const Decoded &decoded, bool redelivered)
{
    if (decoded.Result == LocalQueueResult::WrongType)
    {
        return LocalQueueResult::WrongType;
    }
    // Nobody would take a message out of a queue whose manager has gone.
    if (_queue && _handle.expired() && Find())
    {
        _gate->RoomCame = true;
    }
    if (_wrongKind)
    {
        return LocalQueueResult::Unknown;
    }
    if (!_queue)
    {
        return LocalQueueResult::Full;
    }
    if (!decoded.Message)
    {
        return decoded.Result;
    }
    decoded.Message->SetRedelivered(redelivered);
    if (_queue->AddMessageNoEventTrigger(decoded.Message))
    {
        return LocalQueueResult::Ok;
    }
    // A message may be taken before the gate watches for it, and then nothing would report the room. So try
    // once more.
    return Room() > 0 && _queue->AddMessageNoEventTrigger(decoded.Message) ? LocalQueueResult::Ok
                                                                           : LocalQueueResult::Full;
}

std::size_t AcceptedQueue::Free() const
{
    return static_cast<std::size_t>(
        std::max(0, _queue->GetMaxNoMessagesAllowedInQueue() - _queue->NoMessagesInQueue()));
}

// A sender without credit sends nothing more, so no failing Deliver would raise the flag. It is raised here,
// and the queue is checked once more, since a message may have been taken in between.
std::size_t AcceptedQueue::Room() const
{
    if (!_queue)
    {
        return _wrongKind ? 1 : 0;
    }
    if (const std::size_t room = Free(); room > 0)
    {
        return room;
    }
    _gate->Full = true;
    return Free();
}

bool AcceptedQueue::TakeRoomCame()
{
    return _gate->RoomCame.exchange(false);
}

}  // namespace Rabit
