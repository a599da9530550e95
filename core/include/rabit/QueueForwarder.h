#pragma once

#include <memory>
#include <string>

namespace Rabit
{
class RabitMessage;
class RabitQueueReceipt;

// Takes messages for queues that are not registered in this workspace: the hook by which a queue can live
// elsewhere. Set with RabitWorkspace::SetQueueForwarder.
//
// Both methods are called on the thread that adds the message, on several threads at once, with no lock held.
// They must not call RabitWorkspace::SetQueueForwarder. An exception of theirs passes to the caller of
// AddMessageToQueue.
class QueueForwarder
{
public:
    virtual ~QueueForwarder() = default;
    // Whether this name is one that Forward is for.
    virtual bool Handles(const std::string &queueName) const = 0;
    // Takes the message, which is not null and is shared with the caller, who must not change it any more.
    // The result is what AddMessageToQueue returns: false if it is refused. The receipt, if it is not null,
    // gets a Begin and one outcome for each queue that the message was meant for, refusals included; the
    // outcome may come at any later time, on any thread. Nothing is told to it before Forward is called or if
    // Forward throws.
    virtual bool Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                         const std::shared_ptr<RabitQueueReceipt> &receipt) = 0;
};

}  // namespace Rabit
