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

// The queue forwarders of a workspace. Chooses which of them gets a message. Thread-safe; calls no
// forwarder while it holds its lock.
class WorkspaceForwarders
{
public:
    // Returns false if there is a forwarder of that name.
    bool Add(const std::string &name, std::shared_ptr<QueueForwarder> forwarder);
    // Replaces the forwarder of that name; null removes it. Returns when no call of the former one is in
    // progress.
    void Replace(const std::string &name, std::shared_ptr<QueueForwarder> forwarder);
    std::vector<std::string> Names() const;
    // Returns nothing if no forwarder handles this name.
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
    // Replaced as a whole, never changed: a call keeps the list with which it began.
    std::shared_ptr<const Slots> _slots = std::make_shared<const Slots>();
};

}  // namespace Rabit
