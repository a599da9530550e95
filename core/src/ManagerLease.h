#pragma once

#include <rabit/ManagerStatusMessage.h>
#include <rabit/RabitWorkspace.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace Rabit
{
class ManagerProgress;
class RabitWakeup;

// The registrations of one manager in its workspace. They end with the manager, go when its reactor leaves,
// and come back when that reactor runs again. Thread-safe.
class ManagerLease
{
public:
    // Logs a warning if the workspace has a manager of that name already.
    ManagerLease(RabitWorkspace &workspace, std::shared_ptr<RabitWakeup> wakeup,
                 std::shared_ptr<const ManagerProgress> progress, std::string managerName);
    // If the manager never ran, its names go with it; otherwise its messages stay until a reactor leaves.
    ~ManagerLease();
    ManagerLease(const ManagerLease &) = delete;
    ManagerLease &operator=(const ManagerLease &) = delete;

    bool AddMessage(const std::string &name, const std::shared_ptr<RabitMessage> &msg);
    void AddQueue(const std::string &name, const std::shared_ptr<RabitQueueHandle> &handle);
    // Removes these managers, all of one workspace, together.
    static void Leave(RabitWorkspace &workspace, const std::vector<ManagerLease *> &leases);
    // Before each run: registers everything again if it left. If a name has another global copy by now, the
    // message and its handlers are attached to that one. Warns like the constructor.
    void Return();
    // The global copy of a message that the manager registered under that name, also while it has left; null
    // if there is none.
    std::shared_ptr<PublishSubscribeMessage> FindGlobal(const std::string &name) const;
    // The name under which the manager registered the message of that global copy, or the queue; empty if it
    // registered none such.
    std::string NameOf(const PublishSubscribeMessage *global) const;
    std::string NameOfQueue(const void *queue) const;
    // The names of the manager's queues that have no handler for messages added, without its own queue.
    std::vector<std::string> QueuesWithoutHandlers() const;
    // Fills in the current state of the manager's queues, in the order of registration.
    void ReadQueues(std::vector<QueueStatus_t> &queues) const;
    // Disconnects the handlers that were registered through the manager's messages: they usually call the
    // manager.
    void EndHandlers();
    // Notes that the manager was added to a reactor.
    void AddManagerName();
    // Shuts down all managers that are present in the workspace.
    void RequestShutdownOfAllManagers();

private:
    struct Message
    {
        std::string Name;
        std::shared_ptr<RabitMessage> Local;
        std::shared_ptr<PublishSubscribeMessage> Global;
    };
    struct Queue
    {
        std::string Name;
        std::shared_ptr<RabitQueueHandle> Handle;
    };

    void WarnIfNotAlone(bool alone) const;
    void Restore(const Message &message);

    RabitWorkspace &_workspace;
    const std::shared_ptr<RabitWakeup> _wakeup;
    const std::shared_ptr<const ManagerProgress> _progress;
    const std::string _managerName;
    std::uint64_t _owner = 0;
    mutable std::mutex _mutex;
    std::vector<Message> _messages;
    std::vector<Queue> _queues;
    bool _left = false;
    bool _ran = false;
};

}  // namespace Rabit
