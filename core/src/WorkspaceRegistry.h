#pragma once

#include <rabit/RabitClock.h>
#include <rabit/RabitWorkspace.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace Rabit
{
class ManagerProgress;
class RabitWakeup;

// The tables behind a RabitWorkspace: names, their owners, the managers present. Thread-safe; runs no user
// code while it holds its lock.
//
// A name has owners: the managers that registered it (by number), or 0 if the program did. So the names of
// one reactor can go without disturbing those of another.
class WorkspaceRegistry
{
public:
    explicit WorkspaceRegistry(std::shared_ptr<const RabitClock> clock) : _clock(std::move(clock)) {}

    // Managers. A manager is present from its construction until it is destroyed or its reactor leaves, and
    // again when it runs again.
    std::uint64_t NewOwner();
    // False if another manager of that name is present.
    bool ManagerIsPresent(std::uint64_t owner, const std::string &name,
                          const std::shared_ptr<RabitWakeup> &wakeup,
                          const std::shared_ptr<const ManagerProgress> &progress);
    // Forgets the queues of a destroyed manager. If it never ran, also forgets all that it alone
    // registered; otherwise its messages stay until a reactor leaves.
    void ManagerIsGone(std::uint64_t owner, bool ran);
    // Forgets what only these managers registered, and everything if no manager is present any more.
    void ManagersLeave(const std::vector<std::uint64_t> &owners);
    void RequestShutdownOfAllManagers();
    // The present managers that hang or fail now, sorted by name.
    std::vector<ManagerTrouble> Troubles() const;

    // The name of a manager that was given to a reactor.
    void AddManagerName(const std::string &name, std::uint64_t owner);
    std::vector<std::string> ManagerNames() const;

    // If the name is new, `global` becomes its global copy; null: a clone of the message does.
    MessageRegistration AddMessage(const std::string &name, const std::shared_ptr<RabitMessage> &msg,
                                   std::uint64_t owner,
                                   std::shared_ptr<PublishSubscribeMessage> global = nullptr);
    // Removes the owner from the name. The name goes if that was its last owner.
    void ReleaseMessage(const std::string &name, std::uint64_t owner);
    std::shared_ptr<PublishSubscribeMessage> FindMessage(const std::string &name) const;
    std::vector<MessageInfo> Messages() const;

    // The connection ends when the entry goes.
    void AddQueue(const std::string &name, std::shared_ptr<RabitQueueHandle> handle, std::uint64_t owner,
                  RabitConnection refusals);
    std::shared_ptr<RabitQueueHandle> FindQueue(const std::string &name) const;
    std::vector<QueueInfo> Queues() const;

    void ForgetAllNames();

private:
    using Owners = std::unordered_set<std::uint64_t>;
    struct MessageEntry
    {
        std::shared_ptr<PublishSubscribeMessage> Global;
        std::shared_ptr<RabitMessage> First;  // the message that the name was made with, kept alive
        Owners OwnedBy;
    };
    struct QueueEntry
    {
        std::shared_ptr<RabitQueueHandle> Handle;
        Owners OwnedBy;
        RabitScopedConnection Refusals;
    };
    struct PresentManager
    {
        std::string Name;
        std::shared_ptr<RabitWakeup> Wakeup;
        std::shared_ptr<const ManagerProgress> Progress;
    };
    struct ManagerName
    {
        std::string Name;
        Owners OwnedBy;
    };
    using MessageMap = std::unordered_map<std::string, MessageEntry>;
    using QueueMap = std::unordered_map<std::string, QueueEntry>;
    // Entries removed from the tables. The holder destroys them after the lock is released.
    struct Removed
    {
        std::vector<MessageEntry> Messages;
        std::vector<QueueEntry> Queues;
    };

    template <typename Map, typename List>
    static void RemoveOwned(Map &map, const std::vector<std::uint64_t> &owners, List &removed);

    const std::shared_ptr<const RabitClock> _clock;

    mutable std::mutex _mutex;
    MessageMap _messages;
    QueueMap _queues;
    std::vector<ManagerName> _managerNames;
    std::unordered_map<std::uint64_t, PresentManager> _present;
    std::uint64_t _lastOwner = 0;
};

}  // namespace Rabit
