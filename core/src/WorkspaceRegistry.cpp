#include "WorkspaceRegistry.h"

#include <rabit/RabitWakeup.h>

#include <algorithm>
#include <stdexcept>
#include <typeinfo>
#include <utility>

namespace Rabit
{

std::uint64_t WorkspaceRegistry::AddManager(const std::shared_ptr<RabitWakeup> &wakeup)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _present.emplace(++_lastOwner, wakeup);
    return _lastOwner;
}

void WorkspaceRegistry::ManagerReturns(std::uint64_t owner, const std::shared_ptr<RabitWakeup> &wakeup)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _present.emplace(owner, wakeup);
}

// Takes the owners off all entries, and out those entries that have no owner left through that.
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

void WorkspaceRegistry::ManagerIsGone(std::uint64_t owner)
{
    Removed removed;  // declared before the lock: what it holds is destroyed after the lock is given back
    const std::lock_guard<std::mutex> lock(_mutex);
    _present.erase(owner);
    RemoveOwned(_queues, {owner}, removed.Queues);
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
            wakeups.push_back(manager.second);
        }
    }
    for (const auto &wakeup : wakeups)
    {
        wakeup->RequestShutdown();
    }
}

void WorkspaceRegistry::AddManagerName(const std::string &name)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (std::find(_managerNames.begin(), _managerNames.end(), name) == _managerNames.end())
    {
        _managerNames.push_back(name);
    }
}

std::vector<std::string> WorkspaceRegistry::ManagerNames() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _managerNames;
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
    auto found = _messages.find(name);
    if (found == _messages.end())
    {
        if (!global)
        {
            // Cloning runs the user's code: not under the lock.
            lock.unlock();
            global = std::make_shared<PublishSubscribeMessage>(msg->Clone(), _clock);
            lock.lock();
        }
        const auto inserted = _messages.emplace(name, MessageEntry{global, msg, {owner}});
        if (inserted.second)
        {
            return {MessageRegistrationResult::Created, std::move(global)};
        }
        found = inserted.first;  // somebody was quicker
    }
    if (found->second.Global->MsgTypeIndex() != std::type_index(typeid(*msg)))
    {
        return {MessageRegistrationResult::OtherType, found->second.Global};
    }
    found->second.OwnedBy.insert(owner);
    return {MessageRegistrationResult::Attached, found->second.Global};
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
                                 std::uint64_t owner)
{
    if (!handle)
    {
        throw std::invalid_argument("a null queue cannot be registered as \"" + name + "\"");
    }
    QueueEntry entry{std::move(handle), {owner}};
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
    std::vector<QueueInfo> list;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto &queue : _queues)
        {
            const RabitQueueHandle &handle = *queue.second.Handle;
            list.push_back(QueueInfo{queue.first, handle.ElementType(), handle.Capacity()});
        }
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
