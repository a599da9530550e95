#include "ManagerLease.h"

#include "WorkspaceRegistry.h"

#include <rabit/RabitLog.h>

#include <algorithm>
#include <utility>

namespace Rabit
{

ManagerLease::ManagerLease(RabitWorkspace &workspace, std::shared_ptr<RabitWakeup> wakeup,
                           std::shared_ptr<const ManagerProgress> progress, std::string managerName)
    : _workspace(workspace),
      _wakeup(std::move(wakeup)),
      _progress(std::move(progress)),
      _managerName(std::move(managerName))
{
    _owner = _workspace._registry->NewOwner();
    WarnIfNotAlone(_workspace._registry->ManagerIsPresent(_owner, _managerName, _wakeup, _progress));
}

ManagerLease::~ManagerLease()
{
    EndHandlers();
    _workspace._registry->ManagerIsGone(_owner, _ran);
}

void ManagerLease::WarnIfNotAlone(bool alone) const
{
    if (!alone)
    {
        RabitLog::Write(RabitLogLevel::Warning,
                        "two managers are named \"" + _managerName +
                            "\": the one that was added last gets all messages for that queue");
    }
}

bool ManagerLease::AddMessage(const std::string &name, const std::shared_ptr<RabitMessage> &msg)
{
    const MessageRegistration registration = _workspace.RegisterMessageFor(name, msg, _owner, nullptr);
    if (registration.Result == MessageRegistrationResult::OtherType)
    {
        return false;
    }
    const std::lock_guard<std::mutex> lock(_mutex);
    const bool known =
        std::any_of(_messages.begin(), _messages.end(),
                    [&](const Message &message) { return message.Local == msg && message.Name == name; });
    if (!known)
    {
        registration.Global->_published.DisownAllOf(msg.get());  // of an earlier message at this address
        _messages.push_back(Message{name, msg, registration.Global});
    }
    return true;
}

void ManagerLease::AddQueue(const std::string &name, const std::shared_ptr<RabitQueueHandle> &handle)
{
    _workspace.AddQueue(name, handle, _owner);
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto former =
        std::find_if(_queues.begin(), _queues.end(), [&](const Queue &queue) { return queue.Name == name; });
    if (former != _queues.end())
    {
        former->Handle = handle;
    }
    else
    {
        _queues.push_back(Queue{name, handle});
    }
}

void ManagerLease::Leave(RabitWorkspace &workspace, const std::vector<ManagerLease *> &leases)
{
    std::vector<std::uint64_t> owners;
    for (ManagerLease *lease : leases)
    {
        const std::lock_guard<std::mutex> lock(lease->_mutex);
        lease->_left = true;
        owners.push_back(lease->_owner);
    }
    workspace._registry->ManagersLeave(owners);
}

void ManagerLease::Return()
{
    std::vector<Message> messages;
    std::vector<Queue> queues;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _ran = true;
        if (!std::exchange(_left, false))
        {
            return;
        }
        messages = _messages;
        queues = _queues;
    }
    WarnIfNotAlone(_workspace._registry->ManagerIsPresent(_owner, _managerName, _wakeup, _progress));
    for (const Message &message : messages)
    {
        Restore(message);
    }
    for (const Queue &queue : queues)
    {
        _workspace.AddQueue(queue.Name, queue.Handle, _owner);
    }
}

void ManagerLease::Restore(const Message &message)
{
    const MessageRegistration registration =
        _workspace.RegisterMessageFor(message.Name, message.Local, _owner, message.Global);
    if (registration.Result == MessageRegistrationResult::OtherType || registration.Global == message.Global)
    {
        return;
    }
    RabitMessage *const local = message.Local.get();
    registration.Global->_published.DisownAllOf(local);  // of an earlier message at this address
    message.Global->_published.HandOverAllOf(local, registration.Global->_published);
    const std::lock_guard<std::mutex> lock(_mutex);
    for (Message &own : _messages)
    {
        if (own.Local == message.Local && own.Name == message.Name)
        {
            own.Global = registration.Global;
        }
    }
}

std::shared_ptr<PublishSubscribeMessage> ManagerLease::FindGlobal(const std::string &name) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = std::find_if(_messages.begin(), _messages.end(),
                                    [&](const Message &message) { return message.Name == name; });
    return found == _messages.end() ? nullptr : found->Global;
}

std::string ManagerLease::NameOf(const PublishSubscribeMessage *global) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = std::find_if(_messages.begin(), _messages.end(),
                                    [&](const Message &message) { return message.Global.get() == global; });
    return found == _messages.end() ? "" : found->Name;
}

std::string ManagerLease::NameOfQueue(const void *queue) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = std::find_if(_queues.begin(), _queues.end(),
                                    [&](const Queue &own) { return own.Handle->Queue().get() == queue; });
    return found == _queues.end() ? "" : found->Name;
}

std::vector<std::string> ManagerLease::QueuesWithoutHandlers() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    std::vector<std::string> names;
    for (const Queue &queue : _queues)
    {
        if (queue.Name != _managerName && !queue.Handle->HasEnqueuedHandlers())
        {
            names.push_back(queue.Name);
        }
    }
    return names;
}

void ManagerLease::ReadQueues(std::vector<QueueStatus_t> &queues) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    queues.resize(_queues.size());
    for (std::size_t i = 0; i < _queues.size(); ++i)
    {
        const RabitQueueHandle &handle = *_queues[i].Handle;
        queues[i].Name = _queues[i].Name;
        queues[i].Capacity = handle.Capacity();
        queues[i].FillLevel = handle.FillLevel();
        queues[i].RefusedAdds = handle.RefusedAdds();
    }
}

void ManagerLease::EndHandlers()
{
    std::vector<Message> messages;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        messages = _messages;
    }
    for (const Message &message : messages)
    {
        message.Global->_published.DisconnectAllOf(message.Local.get());
    }
}

void ManagerLease::AddManagerName()
{
    _workspace.AddManagerName(_managerName, _owner);
}

void ManagerLease::RequestShutdownOfAllManagers()
{
    _workspace._registry->RequestShutdownOfAllManagers();
}

}  // namespace Rabit
