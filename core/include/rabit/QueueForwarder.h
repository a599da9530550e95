#pragma once

#include <memory>
#include <string>

namespace Rabit
{
class RabitMessage;

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
    // The result is what AddMessageToQueue returns: false if it is refused.
    virtual bool Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message) = 0;
};

}  // namespace Rabit
