#include "ManagerLease.h"

#include "WorkspaceRegistry.h"

#include <algorithm>
#include <utility>

namespace Rabit
{

ManagerLease::ManagerLease(RabitWorkspace &workspace, std::shared_ptr<RabitWakeup> wakeup)
    : _workspace(workspace), _wakeup(std::move(wakeup)), _owner(workspace._registry->AddManager(_wakeup))
{
}

ManagerLease::~ManagerLease()
{
    EndHandlers();
    _workspace._registry->ManagerIsGone(_owner);
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
        if (!std::exchange(_left, false))
        {
            return;
        }
        messages = _messages;
        queues = _queues;
    }
    _workspace._registry->ManagerReturns(_owner, _wakeup);
    for (const Message &message : messages)
    {
        _workspace.RegisterMessageFor(message.Name, message.Local, _owner, message.Global);
    }
    for (const Queue &queue : queues)
    {
        _workspace.AddQueue(queue.Name, queue.Handle, _owner);
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

void ManagerLease::RequestShutdownOfAllManagers()
{
    _workspace._registry->RequestShutdownOfAllManagers();
}

}  // namespace Rabit
