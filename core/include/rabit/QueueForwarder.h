#pragma once

#include <memory>
#include <string>
#include <vector>

namespace Rabit
{
class RabitMessage;
class RabitQueueReceipt;

// Takes messages for queues that are not registered in this workspace: the hook by which a queue can live
// elsewhere. Given to a workspace with RabitWorkspace::AddQueueForwarder.
//
// There may be several in a workspace, for instance one for each network. A message goes to the one that says
// of its name that it knows the queue (Known), and if several do, to the one that was added first. If none
// does, the first that handles the name gets it, and refuses it with the reason. A name may stand for several
// queues; then each queue gets the message once.
//
// All methods are called on the thread that adds the message, on several threads at once, with no lock held.
// They must not add or remove forwarders. An exception of theirs passes to the caller of AddMessageToQueue.
class QueueForwarder
{
public:
    virtual ~QueueForwarder() = default;
    // Whether this name is one that Forward is for.
    virtual bool Handles(const std::string &queueName) const = 0;
    // Takes the message, which is not null and is shared with the caller, who must not change it any more.
    // The result is what AddMessageToQueue returns: false if the message is refused.
    //
    // The receipt, if it is not null, gets a Begin for each queue that the message is meant for, refusals
    // included. A refusal that makes Forward return false is a Refuse. Any other outcome is a Settle, at any
    // later time and on any thread. Nothing is told to the receipt if Forward throws.
    virtual bool Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                         const std::shared_ptr<RabitQueueReceipt> &receipt) = 0;

    // Asked only if several forwarders handle the name: the names of the queues that it stands for and that
    // this one knows, each of which Forward takes. May be out of date a moment later.
    virtual std::vector<std::string> Known(const std::string &queueName,
                                           const RabitMessage & /*message*/) const
    {
        return {queueName};
    }
    // Another forwarder, which knows it, got a message for that name, which this one handles as well.
    virtual void TakenElsewhere(const std::string & /*queueName*/) {}
};

}  // namespace Rabit
