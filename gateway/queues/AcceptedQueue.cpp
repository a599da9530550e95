#include "queues/AcceptedQueue.h"

#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <typeinfo>
#include <utility>

namespace Rabit
{

AcceptedQueue::AcceptedQueue(const AcceptRule &rule, RabitWorkspace &workspace, std::function<void()> wake)
    : _rule(rule), _workspace(workspace), _gate(std::make_shared<Gate>())
{
    _gate->Wake = std::move(wake);
    for (const std::string &type : rule.Types)
    {
        _types[type] = MessageTypeRegistry::Find(type);
    }
}

bool AcceptedQueue::Find()
{
    const std::shared_ptr<RabitQueueHandle> handle = _workspace.FindQueue(_rule.Queue);
    _wrongKind = handle && handle->QueueType() != typeid(Queue);
    const std::shared_ptr<Queue> queue =
        handle && !_wrongKind ? std::static_pointer_cast<Queue>(handle->Queue()) : nullptr;
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

bool AcceptedQueue::Add(const std::shared_ptr<RabitMessage> &message)
{
    if (_queue->AddMessageNoEventTrigger(message))
    {
        return true;
    }
    // A message may be taken before the flag is up: then nobody would say that there is room, so try once
    // more.
    _gate->Full = true;
    if (!_queue->AddMessageNoEventTrigger(message))
    {
        return false;
    }
    _gate->Full = false;
    return true;
}

LocalQueueResult AcceptedQueue::Deliver(std::string_view typeName, std::span<const std::uint8_t> payload,
                                        bool redelivered)
{
    const auto type = _types.find(typeName);
    if (type == _types.end())
    {
        return LocalQueueResult::WrongType;
    }
    if (_wrongKind)
    {
        return LocalQueueResult::Unknown;
    }
    if (!_queue)
    {
        return LocalQueueResult::Full;
    }
    const std::shared_ptr<RabitMessage> message = type->second->CreateShared();
    if (!type->second->Deserialize(payload, *message))
    {
        return LocalQueueResult::Undecodable;
    }
    message->SetRedelivered(redelivered);
    return Add(message) ? LocalQueueResult::Ok : LocalQueueResult::Full;
}

void AcceptedQueue::Notify()
{
    if (_queue)
    {
        _queue->NotifyEnqueued();
    }
}

std::size_t AcceptedQueue::Room() const
{
    if (!_queue)
    {
        return _wrongKind ? 1 : 0;
    }
    return static_cast<std::size_t>(
        std::max(0, _queue->GetMaxNoMessagesAllowedInQueue() - _queue->NoMessagesInQueue()));
}

bool AcceptedQueue::TakeRoomCame()
{
    return _gate->RoomCame.exchange(false);
}

}  // namespace Rabit
