#pragma once

#include <rabit/RabitWorkspace.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace Rabit
{
class RabitWakeup;

// What one manager registered in its workspace: ends with the manager, goes when its reactor leaves, and
// comes back when that runs again. Thread-safe.
class ManagerLease
{
public:
    ManagerLease(RabitWorkspace &workspace, std::shared_ptr<RabitWakeup> wakeup);
    ~ManagerLease();
    ManagerLease(const ManagerLease &) = delete;
    ManagerLease &operator=(const ManagerLease &) = delete;

    bool AddMessage(const std::string &name, const std::shared_ptr<RabitMessage> &msg);
    void AddQueue(const std::string &name, const std::shared_ptr<RabitQueueHandle> &handle);
    // Has these managers, all of the one workspace, leave it together.
    static void Leave(RabitWorkspace &workspace, const std::vector<ManagerLease *> &leases);
    // Registers everything again if it left. A message whose name was taken meanwhile is attached to what is
    // there now.
    void Return();
    // Disconnects the handlers that were registered through the manager's messages: they usually call the
    // manager.
    void EndHandlers();
    // Has all managers that are present in the workspace shut down.
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

    RabitWorkspace &_workspace;
    const std::shared_ptr<RabitWakeup> _wakeup;
    const std::uint64_t _owner;
    std::mutex _mutex;
    std::vector<Message> _messages;
    std::vector<Queue> _queues;
    bool _left = false;
};

}  // namespace Rabit
