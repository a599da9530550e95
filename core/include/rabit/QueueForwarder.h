#pragma once

#include <memory>
#include <string>
#include <vector>

namespace Rabit
{
class RabitMessage;
class RabitQueueReceipt;

// Accepts messages for queues that are not registered in this workspace, such as those of other nodes.
// Given to a workspace with RabitWorkspace::AddQueueForwarder.
//
// There may be several in a workspace, for instance one for each network. A message goes to the forwarder
// that knows the queue (Known); if several know it, to the one that was added first. If none knows it, the
// first one that handles the name gets the message and refuses it with the reason. A name may stand for
// several queues; then each queue gets the message once.
//
// All methods are called on the thread that adds the message, on several threads at once, with no lock
// held. They must not add or remove forwarders. Their exceptions pass to the caller of AddMessageToQueue.
class QueueForwarder
{
public:
    virtual ~QueueForwarder() = default;
    // True if Forward accepts messages for this name.
    virtual bool Handles(const std::string &queueName) const = 0;
    // Takes the message, which is not null and is shared with the caller, who must not change it any more.
    // The result is what AddMessageToQueue returns: false if the message is refused.
    //
    // The receipt, if it is not null, gets a Begin for each queue that the message is meant for, refusals
    // included. A refusal that makes Forward return false is a Refuse with its reason. Any other outcome is a
    // Settle, at any later time and on any thread. Nothing is told to the receipt if Forward throws.
    virtual bool Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                         const std::shared_ptr<RabitQueueReceipt> &receipt) = 0;

    // Returns those queues that the name stands for and that this forwarder knows; Forward accepts each of
    // them. Called only if several forwarders handle the name. The answer may be out of date a moment
    // later.
    virtual std::vector<std::string> Known(const std::string &queueName,
                                           const RabitMessage & /*message*/) const
    {
        return {queueName};
    }
    // Tells this forwarder, which handles that name too, that another forwarder knew it and got the
    // message.
    virtual void TakenElsewhere(const std::string & /*queueName*/) {}
};

}  // namespace Rabit
