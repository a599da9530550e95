// A queue of this node into which other nodes put messages, for Python.
#pragma once

#include <rabit/RabitEvent.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitWorkspace.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "Codec.h"
#include "Waitable.h"

namespace Rabit::Python
{

struct ReceivedCommand
{
    py::object Value;
    std::string Queue;
    bool IsRedelivered = false;
};

// Messages come on any thread, which needs no GIL. A message that is not taken waits, and holds the sender
// back when the queue is full.
class InboundQueue
{
public:
    using Queue = RabitMessageQueue<std::shared_ptr<RabitMessage>>;

    InboundQueue(const std::string &name, int capacity);

    const std::shared_ptr<Queue> &Local() const { return _queue; }
    std::string Name() const { return _queue->GetMessageQueueName(); }
    bool IsReady() const { return _isClosed || !_queue->IsEmpty(); }
    // Needs the GIL.
    std::optional<ReceivedCommand> Take();
    int Waiting() const { return _queue->NoMessagesInQueue(); }
    Waitable &Ready() { return *_ready; }
    bool IsClosed() const { return _isClosed; }
    void Close();

private:
    const std::shared_ptr<Queue> _queue;
    const std::shared_ptr<Waitable> _ready = std::make_shared<Waitable>();
    RabitScopedConnection _connection;
    std::atomic<bool> _isClosed{false};
};

}  // namespace Rabit::Python
