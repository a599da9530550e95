#pragma once

#include <rabit/QueueForwarder.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace Rabit
{

// The queue forwarders of a workspace, and which of them gets a message. Thread-safe; calls no forwarder
// while it holds its lock.
class WorkspaceForwarders
{
public:
    // False: there is one of that name.
    bool Add(const std::string &name, std::shared_ptr<QueueForwarder> forwarder);
    // Null: none. Returns when no call of the former one is in progress.
    void Replace(const std::string &name, std::shared_ptr<QueueForwarder> forwarder);
    std::vector<std::string> Names() const;
    // Nothing: there is no forwarder for this name.
    std::optional<bool> Forward(const std::string &name, const std::shared_ptr<RabitMessage> &message,
                                const std::shared_ptr<RabitQueueReceipt> &receipt);

private:
    struct Slot
    {
        std::string Name;
        std::shared_ptr<QueueForwarder> Forwarder;
        int CallsInProgress = 0;
    };
    using Slots = std::vector<std::shared_ptr<Slot>>;
    class Calls;

    static bool ForwardAmong(const std::vector<QueueForwarder *> &forwarders, const std::string &name,
                             const std::shared_ptr<RabitMessage> &message,
                             const std::shared_ptr<RabitQueueReceipt> &receipt);

    mutable std::mutex _mutex;
    std::condition_variable _idle;
    // Never changed in place: a call keeps those that there were when it began.
    std::shared_ptr<const Slots> _slots = std::make_shared<const Slots>();
};

}  // namespace Rabit
