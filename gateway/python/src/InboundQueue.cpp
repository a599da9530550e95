#include "InboundQueue.h"

#include <rabit/idl/MessageTypeRegistry.h>

#include "Values.h"

namespace Rabit::Python
{

InboundQueue::InboundQueue(const std::string &name, int capacity)
    : _queue(std::make_shared<Queue>(capacity, name)),
      _connection(_queue->ConnectSomethingEnqueued(RabitQuickHandler([ready = _ready] { ready->Notify(); })))
{
}

std::optional<ReceivedCommand> InboundQueue::Take()
{
    std::shared_ptr<RabitMessage> message;
    if (!_queue->GetMessage(message) || !message)
    {
        return std::nullopt;
    }
    const MessageType *type = MessageTypeRegistry::Of(*message);
    if (type == nullptr)
    {
        throw py::type_error(Name() + ": a message whose type was not made from IDL");
    }
    return ReceivedCommand{ValueOf(*ClassOf(type->Name()), *message), Name(), message->IsRedelivered()};
}

void InboundQueue::Close()
{
    _isClosed = true;
    _ready->Close();
}

}  // namespace Rabit::Python
