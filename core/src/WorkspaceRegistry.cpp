#include "WorkspaceRegistry.h"

#include "ManagerProgress.h"
#include "MessageTypes.h"

#include <rabit/RabitWakeup.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace Rabit
{

std::uint64_t WorkspaceRegistry::NewOwner()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return ++_lastOwner;
}

bool WorkspaceRegistry::ManagerIsPresent(std::uint64_t owner, const std::string &name,
                                         const std::shared_ptr<RabitWakeup> &wakeup,
                                         const std::shared_ptr<const ManagerProgress> &progress)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const bool alone =
        std::none_of(_present.begin(), _present.end(),
                     [&](const auto &other) { return other.first != owner && other.second.Name == name; });
    _present.insert_or_assign(owner, PresentManager{name, wakeup, progress});
    return alone;
}

// Removes the owners from all entries, and then the entries that thereby lost their last owner.
template <typename Map, typename List>
void WorkspaceRegistry::RemoveOwned(Map &map, const std::vector<std::uint64_t> &owners, List &removed)
{
    for (auto entry = map.begin(); entry != map.end();)
    {
        auto &ownedBy = entry->second.OwnedBy;
        std::size_t taken = 0;
        for (const std::uint64_t owner : owners)
        {
            taken += ownedBy.erase(owner);
        }
        if (taken > 0 && ownedBy.empty())
        {
            removed.push_back(std::move(entry->second));
            entry = map.erase(entry);
        }
        else
        {
            ++entry;
        }
    }
}

void WorkspaceRegistry::ManagerIsGone(std::uint64_t owner, bool ran)
{
    Removed removed;  // declared before the lock: its contents are destroyed after the lock is released
    const std::lock_guard<std::mutex> lock(_mutex);
    _present.erase(owner);
    RemoveOwned(_queues, {owner}, removed.Queues);
    if (!ran)
    {
        RemoveOwned(_messages, {owner}, removed.Messages);
        const auto isOfNobody = [&](ManagerName &name)
        { return name.OwnedBy.erase(owner) > 0 && name.OwnedBy.empty(); };
        _managerNames.erase(std::remove_if(_managerNames.begin(), _managerNames.end(), isOfNobody),
                            _managerNames.end());
        return;
    }
    for (auto &message : _messages)
    {
        if (message.second.OwnedBy.erase(owner) > 0)
        {
            message.second.OwnedBy.insert(0);
        }
    }
}

void WorkspaceRegistry::ManagersLeave(const std::vector<std::uint64_t> &owners)
{
    Removed removed;
    MessageMap messages;
    QueueMap queues;
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const std::uint64_t owner : owners)
    {
        _present.erase(owner);
    }
    if (_present.empty())
    {
        _messages.swap(messages);
        _queues.swap(queues);
    }
    else
    {
        RemoveOwned(_messages, owners, removed.Messages);
        RemoveOwned(_queues, owners, removed.Queues);
    }
}

void WorkspaceRegistry::RequestShutdownOfAllManagers()
{
    std::vector<std::shared_ptr<RabitWakeup>> wakeups;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto &manager : _present)
        {
            wakeups.push_back(manager.second.Wakeup);
        }
    }
    for (const auto &wakeup : wakeups)
    {
        wakeup->RequestShutdown();
    }
}

std::vector<ManagerTrouble> WorkspaceRegistry::Troubles() const
{
    std::vector<PresentManager> present;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto &manager : _present)
        {
            present.push_back(manager.second);
        }
    }
    std::vector<ManagerTrouble> troubles;
    const std::chrono::nanoseconds now = _clock->Monotonic();
    for (const PresentManager &manager : present)
    {
        if (const auto trouble = manager.Progress->Trouble(manager.Name, *manager.Wakeup, now))
        {
            troubles.push_back(*trouble);
        }
    }
    std::sort(troubles.begin(), troubles.end(),
              [](const ManagerTrouble &one, const ManagerTrouble &other)
              { return one.Manager < other.Manager; });
    return troubles;
}

void WorkspaceRegistry::AddManagerName(const std::string &name, std::uint64_t owner)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = std::find_if(_managerNames.begin(), _managerNames.end(),
                                    [&](const ManagerName &known) { return known.Name == name; });
    if (found != _managerNames.end())
    {
        found->OwnedBy.insert(owner);
    }
    else
    {
        _managerNames.push_back(ManagerName{name, {owner}});
    }
}

std::vector<std::string> WorkspaceRegistry::ManagerNames() const
{
    std::vector<std::string> names;
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const ManagerName &name : _managerNames)
    {
        names.push_back(name.Name);
    }
    return names;
}

MessageRegistration WorkspaceRegistry::AddMessage(const std::string &name,
                                                  const std::shared_ptr<RabitMessage> &msg,
                                                  std::uint64_t owner,
                                                  std::shared_ptr<PublishSubscribeMessage> global)
{
    if (!msg)
    {
        throw std::invalid_argument("a null message cannot be registered as \"" + name + "\"");
    }
    std::unique_lock<std::mutex> lock(_mutex);
    for (;;)
    {
        auto found = _messages.find(name);
        // Cloning and comparing run the user's code: not under the lock.
        if (found == _messages.end() && !global)
        {
            lock.unlock();
            global = std::make_shared<PublishSubscribeMessage>(msg->Clone(), _clock);
            lock.lock();
            found = _messages.find(name);
        }
        if (found == _messages.end())
        {
            _messages.emplace(name, MessageEntry{global, msg, {owner}});
            return {MessageRegistrationResult::Created, std::move(global)};
        }
        const std::shared_ptr<PublishSubscribeMessage> known = found->second.Global;
        lock.unlock();
        const bool isSame = IsSameType(*known, *msg);
        lock.lock();
        if (!isSame)
        {
            return {MessageRegistrationResult::OtherType, known};
        }
        found = _messages.find(name);
        if (found != _messages.end() && found->second.Global == known)
        {
            found->second.OwnedBy.insert(owner);
            return {MessageRegistrationResult::Attached, known};
        }
    }
}

void WorkspaceRegistry::ReleaseMessage(const std::string &name, std::uint64_t owner)
{
    MessageMap::node_type removed;  // destroyed after the lock is released
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _messages.find(name);
    if (found != _messages.end() && found->second.OwnedBy.erase(owner) > 0 && found->second.OwnedBy.empty())
    {
        removed = _messages.extract(found);
    }
}

std::shared_ptr<PublishSubscribeMessage> WorkspaceRegistry::FindMessage(const std::string &name) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _messages.find(name);
    return found == _messages.end() ? nullptr : found->second.Global;
}

std::vector<MessageInfo> WorkspaceRegistry::Messages() const
{
    std::vector<MessageInfo> list;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto &message : _messages)
        {
            const PublishSubscribeMessage &global = *message.second.Global;
            list.push_back(MessageInfo{message.first, global.MsgTypeIndex(), global.GetNumberOfPosts()});
        }
    }
    std::sort(list.begin(), list.end(),
              [](const MessageInfo &left, const MessageInfo &right) { return left.Name < right.Name; });
    return list;
}

void WorkspaceRegistry::AddQueue(const std::string &name, std::shared_ptr<RabitQueueHandle> handle,
                                 std::uint64_t owner, RabitConnection refusals)
{
    if (!handle)
    {
        throw std::invalid_argument("a null queue cannot be registered as \"" + name + "\"");
    }
    QueueEntry entry{std::move(handle), {owner}, std::move(refusals)};
    // Swapping leaves a former queue to be destroyed outside the lock.
    const std::lock_guard<std::mutex> lock(_mutex);
    QueueEntry &current = _queues[name];
    if (current.Handle && current.Handle->Queue() == entry.Handle->Queue())
    {
        current.OwnedBy.insert(owner);
        return;
    }
    std::swap(current, entry);
}

std::shared_ptr<RabitQueueHandle> WorkspaceRegistry::FindQueue(const std::string &name) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _queues.find(name);
    return found == _queues.end() ? nullptr : found->second.Handle;
}

std::vector<QueueInfo> WorkspaceRegistry::Queues() const
{
    std::vector<std::pair<std::string, std::shared_ptr<RabitQueueHandle>>> queues;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto &queue : _queues)
        {
            queues.emplace_back(queue.first, queue.second.Handle);
        }
    }
    // Asking a queue takes its lock.
    std::vector<QueueInfo> list;
    for (const auto &[name, handle] : queues)
    {
        list.push_back(QueueInfo{name, handle->ElementType(), handle->Capacity(), handle->FillLevel(),
                                 handle->RefusedAdds()});
    }
    std::sort(list.begin(), list.end(),
              [](const QueueInfo &left, const QueueInfo &right) { return left.Name < right.Name; });
    return list;
}

void WorkspaceRegistry::ForgetAllNames()
{
    MessageMap messages;
    QueueMap queues;
    const std::lock_guard<std::mutex> lock(_mutex);
    _messages.swap(messages);
    _queues.swap(queues);
}

}  // namespace Rabit
