#include <rabit/RabitWorkspace.h>

#include "QueueRefusals.h"
#include "WorkspaceForwarders.h"
#include "WorkspaceRegistry.h"

#include <rabit/RabitLog.h>

#include <boost/core/demangle.hpp>

#include <algorithm>
#include <iterator>
#include <optional>

namespace Rabit
{

RabitWorkspace *RabitWorkspace::GetWorkspace()
{
    // Never destroyed: objects of any lifetime may use it while the process ends.
    static RabitWorkspace *const workspace = new RabitWorkspace();
    return workspace;
}

RabitWorkspace::RabitWorkspace(std::shared_ptr<RabitClock> clock)
    : _clock(clock ? std::move(clock) : RabitClock::System()),
      _registry(std::make_unique<WorkspaceRegistry>(_clock)),
      _forwarders(std::make_unique<WorkspaceForwarders>()),
      _refusals(std::make_shared<QueueRefusals>(_clock))
{
}

RabitWorkspace::~RabitWorkspace() = default;

void RabitWorkspace::LeavingReactor()
{
    _registry->ForgetAllNames();
}

int RabitWorkspace::GetManagerIndexNumber(std::string managerName)
{
    const std::vector<std::string> names = _registry->ManagerNames();
    const auto found = std::find(names.begin(), names.end(), managerName);
    return found == names.end() ? -1 : static_cast<int>(std::distance(names.begin(), found));
}

bool RabitWorkspace::DoesManagerExist(std::string managerName)
{
    return GetManagerIndexNumber(std::move(managerName)) >= 0;
}

std::vector<std::string> RabitWorkspace::GetListOfManagerNames()
{
    return _registry->ManagerNames();
}

void RabitWorkspace::AddManagerName(const std::string &managerName, std::uint64_t owner)
{
    _registry->AddManagerName(managerName, owner);
}

void RabitWorkspace::AddQueue(std::string name, std::shared_ptr<RabitQueueHandle> handle, std::uint64_t owner)
{
    RabitConnection refusals;
    if (handle)
    {
        refusals = handle->ConnectRefused([noted = _refusals, name, capacity = handle->Capacity()]
                                          { noted->NoteFull(name, capacity); });
    }
    _registry->AddQueue(name, std::move(handle), owner, refusals);
}

std::shared_ptr<RabitQueueHandle> RabitWorkspace::FindQueue(const std::string &name) const
{
    return _registry->FindQueue(name);
}

std::shared_ptr<RabitQueueHandle> RabitWorkspace::FindQueueOrThrow(const std::string &name) const
{
    std::shared_ptr<RabitQueueHandle> handle = _registry->FindQueue(name);
    if (!handle)
    {
        throw MessageNotRegisteredException("no queue is registered as \"" + name + "\"");
    }
    return handle;
}

QueueAddResult RabitWorkspace::DeliverToQueue(const std::string &name,
                                              const std::shared_ptr<RabitMessage> &message)
{
    if (!message)
    {
        throw std::invalid_argument("a null message cannot be delivered to queue \"" + name + "\"");
    }
    const std::shared_ptr<RabitQueueHandle> handle = _registry->FindQueue(name);
    return handle ? handle->AddMessage(message) : QueueAddResult::UnknownQueue;
}

RabitConnection RabitWorkspace::ConnectEnqueuedEvent(const std::string &name, RabitHandler handler)
{
    const std::shared_ptr<RabitQueueHandle> queue = _registry->FindQueue(name);
    return queue ? queue->ConnectEnqueued(std::move(handler)) : RabitConnection();
}

RabitConnection RabitWorkspace::ConnectDequeuedEvent(const std::string &name, RabitHandler handler)
{
    const std::shared_ptr<RabitQueueHandle> queue = _registry->FindQueue(name);
    return queue ? queue->ConnectDequeued(std::move(handler)) : RabitConnection();
}

bool RabitWorkspace::AddQueueForwarder(const std::string &forwarderName,
                                       std::shared_ptr<QueueForwarder> forwarder)
{
    return _forwarders->Add(forwarderName, std::move(forwarder));
}

void RabitWorkspace::RemoveQueueForwarder(const std::string &forwarderName)
{
    _forwarders->Replace(forwarderName, nullptr);
}

std::vector<std::string> RabitWorkspace::GetListOfQueueForwarders() const
{
    return _forwarders->Names();
}

void RabitWorkspace::SetQueueForwarder(std::shared_ptr<QueueForwarder> forwarder)
{
    _forwarders->Replace("", std::move(forwarder));
}

bool RabitWorkspace::ForwardMessage(const std::string &name, const std::shared_ptr<RabitMessage> &message,
                                    const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    const std::optional<bool> forwarded = _forwarders->Forward(name, message, receipt);
    return forwarded ? *forwarded : RefuseUnknown(name, receipt);
}

bool RabitWorkspace::RefuseUnknown(const std::string &name, const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    _refusals->NoteUnknown(name);
    return TellRefused(receipt, receipt ? RefusalReasonOf(QueueAddResult::UnknownQueue, name) : "");
}

bool RabitWorkspace::TellDelivered(const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    if (receipt)
    {
        receipt->Begin();
        receipt->Settle(QueueOutcome::Delivered);
    }
    return true;
}

bool RabitWorkspace::TellRefused(const std::shared_ptr<RabitQueueReceipt> &receipt, std::string reason)
{
    if (receipt)
    {
        receipt->Begin();
        receipt->Refuse(std::move(reason));
    }
    return false;
}

bool RabitWorkspace::AddPublishSubscribeMessage(std::string name, std::shared_ptr<RabitMessage> msg)
{
    return RegisterMessage(name, msg).Result != MessageRegistrationResult::OtherType;
}

MessageRegistration RabitWorkspace::RegisterMessage(const std::string &name,
                                                    const std::shared_ptr<RabitMessage> &msg)
{
    return RegisterMessageFor(name, msg, 0, nullptr);
}

MessageRegistration RabitWorkspace::RegisterMessageFor(const std::string &name,
                                                       const std::shared_ptr<RabitMessage> &msg,
                                                       std::uint64_t owner,
                                                       std::shared_ptr<PublishSubscribeMessage> global)
{
    const bool comesBack = global != nullptr;
    MessageRegistration registration = _registry->AddMessage(name, msg, owner, std::move(global));
    if (comesBack && msg->_globalPublishSubscribeMessageRef == registration.Global)
    {
        return registration;  // already attached here: it keeps what it has seen
    }
    switch (registration.Result)
    {
        case MessageRegistrationResult::Created:
            registration.Global->AttachAsCurrent(*msg);
            msg->SetGlobalPublishSubscribeMessageRef(registration.Global);
            break;
        case MessageRegistrationResult::Attached:
            msg->_seenSource = RabitMessage::NothingSeenYet;  // the first fetch gets what was posted before
            msg->SetGlobalPublishSubscribeMessageRef(registration.Global);
            break;
        case MessageRegistrationResult::OtherType:
            RabitLog::Write(RabitLogLevel::Error,
                            "message \"" + name + "\" is of type " +
                                boost::core::demangle(registration.Global->MsgTypeIndex().name()) +
                                ": a message of another type, " +
                                boost::core::demangle(msg->GetTypeIndex().name()) +
                                ", was not attached to it");
            break;
    }
    return registration;
}

std::shared_ptr<PublishSubscribeMessage> RabitWorkspace::FindGlobalMessage(const std::string &name) const
{
    return _registry->FindMessage(name);
}

std::unique_ptr<RabitMessage> RabitWorkspace::GetMessage(std::string name)
{
    const std::shared_ptr<PublishSubscribeMessage> global = _registry->FindMessage(name);
    return global ? global->GetCopyOfMessage() : nullptr;
}

bool RabitWorkspace::FetchMessage(std::string name, RabitMessage *msg)
{
    const std::shared_ptr<PublishSubscribeMessage> global = _registry->FindMessage(name);
    return global && global->FetchMessage(msg);
}

bool RabitWorkspace::ForceFetchMessage(std::string name, RabitMessage *msg)
{
    const std::shared_ptr<PublishSubscribeMessage> global = _registry->FindMessage(name);
    return global && global->ForceFetch(msg);
}

void RabitWorkspace::SetManagerTracing(RabitManagerTracing tracing)
{
    const std::lock_guard<std::mutex> lock(_tracingMutex);
    _tracing = std::move(tracing);
}

std::shared_ptr<RabitManagerTrace> RabitWorkspace::TraceOf(const std::string &managerName) const
{
    RabitManagerTracing tracing;
    {
        const std::lock_guard<std::mutex> lock(_tracingMutex);
        tracing = _tracing;
    }
    return tracing ? tracing(managerName) : nullptr;
}

std::vector<MessageInfo> RabitWorkspace::GetListOfMessages() const
{
    std::vector<MessageInfo> messages = _registry->Messages();
    if (RabitManagerTrace::Current() != nullptr)
    {
        const RabitManagerTrace::Pause trace;
        trace->Listed(messages);
    }
    return messages;
}

std::vector<QueueInfo> RabitWorkspace::GetListOfQueues() const
{
    return _registry->Queues();
}

std::vector<UnknownQueueInfo> RabitWorkspace::GetListOfUnknownQueues() const
{
    return _refusals->Unknown();
}

std::vector<ManagerTrouble> RabitWorkspace::GetListOfTroubledManagers() const
{
    return _registry->Troubles();
}

}  // namespace Rabit
