#include <rabit/RabitManager.h>

#include "ManagerLease.h"
#include "ManagerProgress.h"

#include <rabit/GlobalPublishSubscribeException.h>
#include <rabit/RabitLog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

// Names, messages, queues and wake-ups of a manager. RabitManagerRun.cpp has its loop.
namespace Rabit
{
namespace
{

constexpr double LongestDelay_Sec = 1e9;

// Converts seconds given by a caller; a positive value never becomes 0.
std::chrono::nanoseconds ToDuration(double seconds)
{
    const double nanoseconds = std::clamp(seconds, 0.0, LongestDelay_Sec) * 1e9;
    const std::chrono::nanoseconds rounded(static_cast<std::chrono::nanoseconds::rep>(nanoseconds + 0.5));
    return seconds > 0.0 ? std::max(rounded, std::chrono::nanoseconds(1)) : rounded;
}

template <typename T>
std::shared_ptr<T> RegisterOrThrow(ManagerLease &lease, const std::string &name)
{
    auto message = std::make_shared<T>();
    if (!lease.AddMessage(name, message))
    {
        throw std::invalid_argument("message name \"" + name + "\", which every manager needs, is taken");
    }
    return message;
}

}  // namespace

RabitManager::RabitManager(std::string name) : RabitManager(std::move(name), *RabitWorkspace::GetWorkspace())
{
}

RabitManager::RabitManager(std::string name, int queueCapacity)
    : RabitManager(std::move(name), *RabitWorkspace::GetWorkspace(), queueCapacity)
{
}

RabitManager::RabitManager(std::string name, RabitWorkspace &workspace, int queueCapacity)
    : _name(std::move(name)),
      _workspace(workspace),
      _wakeup(std::make_shared<RabitWakeup>()),
      _progress(std::make_shared<ManagerProgress>()),
      _lease(std::make_unique<ManagerLease>(workspace, _wakeup, _progress, _name))
{
    _mgrMessageQueue_sptr = std::make_shared<RabitQueue>(queueCapacity, _name);
    RegisterQueue(_name, RabitWorkspace::MakeQueueHandle(_mgrMessageQueue_sptr));
    WakeUpManagerOnEnqueue(_mgrMessageQueue_sptr);

    _mgrControlAllMgrs_sptr = RegisterOrThrow<ManagerControlMessage>(*_lease, "ManagerControlMessage");
    _mgrControlThisMgr_sptr =
        RegisterOrThrow<ManagerControlMessage>(*_lease, _name + ":ManagerControlMessage");
    const RabitHandler onControl = RabitQuickHandler([wakeup = _wakeup] { wakeup->SignalControlChange(); });
    AddMessageWakeup(_mgrControlAllMgrs_sptr, onControl);
    AddMessageWakeup(_mgrControlThisMgr_sptr, onControl);
    TakeControlMessagesAsRead();

    _mgrStatus_sptr = RegisterOrThrow<ManagerStatusMessage>(*_lease, _name + ":ManagerStatusMessage");
    _mgrStatus_sptr->ManagerName = _name;
    _mgrStatus_sptr->RunningState = ManagerStatusMessage::MgrState_Startup;
    _lease->ReadQueues(_mgrStatus_sptr->Queues);
    _mgrStatus_sptr->PostMessage();
}

RabitManager::~RabitManager()
{
    EndHandlers();
    if (!_thread.joinable())
    {
        return;
    }
    // The derived class is already destroyed, so this is not safe, but better than std::terminate.
    RabitLog::Write(RabitLogLevel::Error, "manager \"" + _name + "\" was destroyed without being joined");
    _wakeup->RequestShutdown();
    if (_thread.get_id() == std::this_thread::get_id())
    {
        _thread.detach();
    }
    else
    {
        _thread.join();
    }
}

// Handlers that the program registered through the manager's messages, or on its own queue, usually call the
// manager.
void RabitManager::EndHandlers()
{
    _lease->EndHandlers();
    if (_mgrMessageQueue_sptr)
    {
        _mgrMessageQueue_sptr->DisconnectAllHandlers();
    }
}

void RabitManager::SetWakeupManagerUponMessagePostedToManagersMessageQueue()
{
    SetWakeupManagerUponMessagePostedToManagersMessageQueue(true);
}

void RabitManager::SetWakeupManagerUponMessagePostedToManagersMessageQueue(bool wakeUp)
{
    if (wakeUp)
    {
        WakeUpManagerOnEnqueue(_mgrMessageQueue_sptr);
        return;
    }
    const void *const own = _mgrMessageQueue_sptr.get();
    const std::lock_guard<std::mutex> lock(_wakeupsMutex);
    _queueWakeups.erase(std::remove_if(_queueWakeups.begin(), _queueWakeups.end(),
                                       [&](const QueueWakeup &wakeup) {
                                           return wakeup.Queue == own && wakeup.Event == QueueEvent::Enqueued;
                                       }),
                        _queueWakeups.end());
}

void RabitManager::SetWakeupTimeDelayMSec(int delay_MSec)
{
    _wakeup->SetDelay(std::chrono::milliseconds(delay_MSec));
    _delayIsChosen.store(true);
}

void RabitManager::SetWakeupTimeDelaySec(double delay_Sec)
{
    if (std::isnan(delay_Sec))
    {
        throw std::invalid_argument("the wake-up delay of manager \"" + _name + "\" cannot be NaN");
    }
    _wakeup->SetDelay(ToDuration(delay_Sec));
    _delayIsChosen.store(true);
}

int RabitManager::GetWakeupTimeDelayMSec() const
{
    const std::chrono::nanoseconds delay = _wakeup->GetDelay();
    if (delay <= std::chrono::nanoseconds::zero())
    {
        return 0;
    }
    const auto rounded = std::chrono::round<std::chrono::milliseconds>(delay).count();
    return static_cast<int>(std::clamp<std::int64_t>(rounded, 1, std::numeric_limits<int>::max()));
}

double RabitManager::GetWakeupTimeDelaySec() const
{
    return std::chrono::duration<double>(_wakeup->GetDelay()).count();
}

void RabitManager::SetPeriodSec(double period_Sec)
{
    if (std::isnan(period_Sec))
    {
        throw std::invalid_argument("the period of manager \"" + _name + "\" cannot be NaN");
    }
    _wakeup->SetPeriod(ToDuration(period_Sec));
    _settingsChanged.store(true);
}

double RabitManager::GetPeriodSec() const
{
    return std::chrono::duration<double>(_wakeup->GetPeriod()).count();
}

void RabitManager::SetWakeupBetweenTurns(bool wakeUp)
{
    _wakeup->SetSignalsBetweenTurns(wakeUp);
    _betweenTurnsIsChosen.store(true);
}

bool RabitManager::IsTurn() const
{
    return _wakeup->IsTurn();
}

std::uint64_t RabitManager::GetNumberOfMissedTurns() const
{
    return _wakeup->MissedTurns();
}

bool RabitManager::RegisterMessage(const std::string &name, const std::shared_ptr<RabitMessage> &msg)
{
    return _lease->AddMessage(name, msg);
}

void RabitManager::RegisterQueue(std::string name, std::shared_ptr<RabitQueueHandle> handle)
{
    _lease->AddQueue(name, handle);
    _settingsChanged.store(true);
}

bool RabitManager::FetchMessage(std::string name, RabitMessage *msg)
{
    return _workspace.FetchMessage(std::move(name), msg);
}

bool RabitManager::ForceFetchMessage(std::string name, RabitMessage *msg)
{
    return _workspace.ForceFetchMessage(std::move(name), msg);
}

bool RabitManager::DoesManagerExist(std::string managerName)
{
    return _workspace.DoesManagerExist(std::move(managerName));
}

int RabitManager::GetManagerIndexNumber(std::string managerName)
{
    return _workspace.GetManagerIndexNumber(std::move(managerName));
}

int RabitManager::GetManagerIndexNumber()
{
    return _workspace.GetManagerIndexNumber(_name);
}

std::vector<std::string> RabitManager::GetListOfManagerNames()
{
    return _workspace.GetListOfManagerNames();
}

void RabitManager::AddMessageWakeup(const std::shared_ptr<RabitMessage> &msg, const RabitHandler &handler)
{
    if (!msg)
    {
        throw std::invalid_argument("manager \"" + _name + "\" cannot be woken by a null message");
    }
    const std::shared_ptr<PublishSubscribeMessage> global = msg->GetGlobalPublishSubscribeMessageRef();
    if (!global)
    {
        throw GlobalPublishSubscribeException("manager \"" + _name +
                                              "\" cannot be woken by a message that is not registered");
    }
    const std::lock_guard<std::mutex> lock(_wakeupsMutex);
    const bool known = std::any_of(_messageWakeups.begin(), _messageWakeups.end(),
                                   [&](const MessageWakeup &wakeup)
                                   { return wakeup.Global == global && wakeup.Connection.IsConnected(); });
    if (!known)
    {
        _messageWakeups.push_back(
            MessageWakeup{msg, handler, global, global->ConnectSomethingPublished(handler)});
        _settingsChanged.store(true);
    }
}

// After the names were registered again, a message may be attached to another global copy.
void RabitManager::RenewMessageWakeups()
{
    const std::lock_guard<std::mutex> lock(_wakeupsMutex);
    for (MessageWakeup &wakeup : _messageWakeups)
    {
        const std::shared_ptr<RabitMessage> message = wakeup.Message.lock();
        const auto global = message ? message->GetGlobalPublishSubscribeMessageRef() : nullptr;
        if (global && global != wakeup.Global)
        {
            wakeup.Connection = global->ConnectSomethingPublished(wakeup.Handler);
            wakeup.Global = global;
        }
    }
}

void RabitManager::WakeUpManagerOnOutcome(const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    if (!receipt)
    {
        throw std::invalid_argument("WakeUpManagerOnOutcome needs a receipt");
    }
    const std::lock_guard<std::mutex> lock(_wakeupsMutex);
    // A manager that sends requests has a new receipt for each: only the first of them changes its settings.
    const bool isFirst =
        std::none_of(_queueWakeups.begin(), _queueWakeups.end(),
                     [](const QueueWakeup &wakeup) { return wakeup.Event == QueueEvent::Settled; });
    ForgetEndedQueueWakeups();
    if (HasQueueWakeup(receipt.get(), QueueEvent::Settled))
    {
        return;
    }
    _queueWakeups.push_back(
        QueueWakeup{receipt.get(), QueueEvent::Settled, receipt->ConnectOutcomeKnown(WakeUpHandler())});
    if (isFirst)
    {
        _settingsChanged.store(true);
    }
}

// A new queue may get the address of a destroyed one.
void RabitManager::ForgetEndedQueueWakeups()
{
    _queueWakeups.erase(
        std::remove_if(_queueWakeups.begin(), _queueWakeups.end(),
                       [](const QueueWakeup &wakeup) { return !wakeup.Connection.IsConnected(); }),
        _queueWakeups.end());
}

bool RabitManager::HasQueueWakeup(const void *queue, QueueEvent event) const
{
    return std::any_of(_queueWakeups.begin(), _queueWakeups.end(),
                       [&](const QueueWakeup &wakeup)
                       { return wakeup.Queue == queue && wakeup.Event == event; });
}

void RabitManager::WriteLog(RabitLogLevel level, const std::string &text) const noexcept
{
    try
    {
        RabitLog::Write(level, _name + ": " + text);
    }
    catch (...)  // out of memory for the line
    {
    }
}

void RabitManager::WakeUpManagerEH()
{
    _wakeup->Signal();
}

RabitHandler RabitManager::WakeUpHandler() const
{
    return RabitQuickHandler([wakeup = _wakeup] { wakeup->Signal(); });
}

}  // namespace Rabit
