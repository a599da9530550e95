#include "ExceptionText.h"
#include "ManagerLease.h"
#include "ManagerProgress.h"
#include "QueueRefusals.h"

#include <rabit/RabitLog.h>
#include <rabit/RabitManager.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <pthread.h>

// The loop of a manager: its thread, or a stepped reactor, calls the steps below.
namespace Rabit
{
namespace
{

// The least sleep after a unit of work that threw; the second value is for a manager that otherwise does
// not sleep.
constexpr std::chrono::milliseconds PauseAfterFailure(10);
constexpr std::chrono::milliseconds PauseAfterFailureWithoutDelay(100);
// The least time between two log lines about a manager that keeps failing.
constexpr std::chrono::seconds FailureLogPeriod(1);

double InSeconds(std::chrono::nanoseconds duration)
{
    return std::chrono::duration<double>(duration).count();
}

ManagerStatusMessage::ErrorCode_e ErrorCodeOf(ManagerProgress::Step step)
{
    switch (step)
    {
        case ManagerProgress::Step::Startup:
            return ManagerStatusMessage::Error_Startup;
        case ManagerProgress::Step::Shutdown:
            return ManagerStatusMessage::Error_Shutdown;
        case ManagerProgress::Step::UnitOfWork:
            break;
    }
    return ManagerStatusMessage::Error_ExecuteUnitOfWork;
}

// Counters stay at the largest int.
void Add(int &counter, int count)
{
    counter = (counter > std::numeric_limits<int>::max() - count) ? std::numeric_limits<int>::max()
                                                                  : counter + count;
}

void Increment(int &counter)
{
    Add(counter, 1);
}

}  // namespace

void RabitManager::Run()
{
    if (_thread.joinable())
    {
        throw std::logic_error("manager \"" + _name + "\" is running already");
    }
    PrepareRun();
    try
    {
        _thread = std::thread([this] { ThreadMain(); });
    }
    catch (...)
    {
        _loopActive.store(false);
        throw;
    }
}

void RabitManager::Join()
{
    _thread.join();
    FinishRun();
}

void RabitManager::ShutdownManager()
{
    _wakeup->RequestShutdown();
}

void RabitManager::ShutdownAllManagers(bool value)
{
    if (value)
    {
        _lease->RequestShutdownOfAllManagers();
    }
    // The manager's own copy belongs to its thread, or to the one that starts and joins it.
    if (IsInItsLoop())
    {
        _mgrControlAllMgrs_sptr->ShutdownManager(value);
        _mgrControlAllMgrs_sptr->PostMessage();
        return;
    }
    ManagerControlMessage control;
    const auto global = _lease->FindGlobal("ManagerControlMessage");
    global->ForceFetchMessage(&control);
    control.ShutdownManager(value);
    global->PostMessage(&control);
}

bool RabitManager::IsInItsLoop() const
{
    return _loopActive.load() && _loopThread.load() == std::this_thread::get_id();
}

void RabitManager::ThreadMain()
{
    pthread_setname_np(pthread_self(), _name.substr(0, 15).c_str());
    if (StartupStep())
    {
        _wakeup->BeginTurns(RabitWakeup::SteadyNow());
        while (CycleStep())
        {
            SleepStep();
        }
    }
    ShutdownStep();
}

void RabitManager::PrepareRun()
{
    const auto formerControls = ControlGlobals();
    _lease->Return();
    RenewMessageWakeups();
    if (ControlGlobals() != formerControls)
    {
        TakeControlMessagesAsRead();
    }
    _trace = _workspace.TraceOf(_name);
    _progress->Recovered();
    _startupFailed = false;
    _lastPassFailed = false;
    _loopThread.store(std::thread::id());
    _loopActive.store(true);
}

bool RabitManager::StartupStep()
{
    _loopThread.store(std::this_thread::get_id());
    if (_mgrStatus_sptr->RunningState != ManagerStatusMessage::MgrState_Startup)
    {
        _mgrStatus_sptr->RunningState = ManagerStatusMessage::MgrState_Startup;
        _mgrStatus_sptr->ErrorCondition = false;
        _mgrStatus_sptr->ErrorCode = ManagerStatusMessage::Error_None;
        PostStatus();
    }
    const std::chrono::nanoseconds now = _workspace.GetClock().Monotonic();
    _statsResetAt = now;
    _statusPostedAt = now;
    _startupFailed = !Guard(ManagerProgress::Step::Startup, now, [this] { Startup(); });
    if (_startupFailed)
    {
        return false;
    }
    _mgrStatus_sptr->RunningState = ManagerStatusMessage::MgrState_Running;
    PostStatus();
    _wakeup->ForgetSignals();  // the first unit of work sees all that they announced
    return true;
}

bool RabitManager::CycleStep()
{
    // The path from a wake-up to the unit of work is kept short, so this reads as little as possible.
    if (_wakeup->TakeControlChange())
    {
        FetchControlMessages();
        ObeyControlMessages();
    }
    if (_wakeup->IsShutdownRequested())
    {
        return false;
    }
    if (!_wakeup->IsWorkDue())
    {
        return true;
    }
    const RabitClock &clock = _workspace.GetClock();
    const std::chrono::nanoseconds start = clock.Monotonic();
    const bool good = Guard(ManagerProgress::Step::UnitOfWork, start, [this] { ExecuteUnitOfWork(); });
    const std::chrono::nanoseconds end = clock.Monotonic();
    SystemTimeClock::GetSystemTimeClock()->ReportSteps();
    _workspace._refusals->Report();
    CountPass(start, end);
    try
    {
        if (end - start >= ManagerProgress::LongWork)
        {
            WarnOfLongWork(end - start);
        }
        if (_settingsChanged.load(std::memory_order_relaxed))
        {
            WarnOfSettings();
        }
    }
    catch (...)  // out of memory for a warning
    {
    }
    ObeyControlMessages();  // the unit of work may have changed them
    if (good && _lastPassFailed)
    {
        _progress->Recovered();
        _mgrStatus_sptr->ErrorCondition = false;
        _mgrStatus_sptr->ErrorCode = ManagerStatusMessage::Error_None;
        PostStatus();
    }
    _lastPassFailed = !good;
    PostStatusIfDue(end);
    return true;
}

// Adds this pass, and the sleep before it, to the statistics.
void RabitManager::CountPass(std::chrono::nanoseconds start, std::chrono::nanoseconds end)
{
    if (std::exchange(_slept, false))
    {
        _stats.UpdateSleepTimeStats(InSeconds(start - _sleepBegan));
    }
    Increment(_stats.TotalNumberOfExecuteCycles);
    Increment(_stats.NumberOfExecuteCycles);
    _stats.UpdateExeUnitOfWorkTimeStats(InSeconds(end - start));
    _sleepBegan = end;
}

std::chrono::nanoseconds RabitManager::PauseOfThisSleep() const
{
    if (!_lastPassFailed)
    {
        return std::chrono::nanoseconds::zero();
    }
    return _wakeup->MaySleep() ? PauseAfterFailure : PauseAfterFailureWithoutDelay;
}

void RabitManager::SleepStep()
{
    _slept = _wakeup->Sleep(PauseOfThisSleep());
}

void RabitManager::BeginSleepStep()
{
    _sleepBegan = _workspace.GetClock().Monotonic();
    _wakeup->BeginSleep();
}

std::chrono::nanoseconds RabitManager::NextDue() const
{
    if (_wakeup->IsShutdownRequested())
    {
        return _sleepBegan;
    }
    return std::max(_sleepBegan + PauseOfThisSleep(), _wakeup->SleepUntil(_sleepBegan));
}

void RabitManager::EndSleepStep(std::chrono::nanoseconds now)
{
    _wakeup->EndSleep(_sleepBegan, now);
    _slept = now > _sleepBegan;
}

void RabitManager::ShutdownStep()
{
    _mgrStatus_sptr->RunningState = ManagerStatusMessage::MgrState_Shutdown;
    const std::chrono::nanoseconds now = _workspace.GetClock().Monotonic();
    UpdateStats(now);
    PostStatus();
    // A manager that has ended well fails no more, however its last unit of work ended.
    if (Guard(ManagerProgress::Step::Shutdown, now, [this] { Shutdown(); }) && !_startupFailed)
    {
        _progress->Recovered();
    }
    _loopActive.store(false);
}

void RabitManager::FinishRun()
{
    TakeControlMessagesAsRead();
    _wakeup->Reset();
}

std::pair<std::shared_ptr<PublishSubscribeMessage>, std::shared_ptr<PublishSubscribeMessage>>
RabitManager::ControlGlobals() const
{
    return {_mgrControlAllMgrs_sptr->GetGlobalPublishSubscribeMessageRef(),
            _mgrControlThisMgr_sptr->GetGlobalPublishSubscribeMessageRef()};
}

// Ignores the control messages posted so far: this manager did not exist, or did not run, at that time.
void RabitManager::TakeControlMessagesAsRead()
{
    for (const auto &control : {_mgrControlAllMgrs_sptr, _mgrControlThisMgr_sptr})
    {
        control->GetGlobalPublishSubscribeMessageRef()->ForceFetchMessage(control.get());
        control->ShutdownManager(false);
    }
    _resetToggles = {_mgrControlAllMgrs_sptr->ResetMgrStatsToggle,
                     _mgrControlThisMgr_sptr->ResetMgrStatsToggle};
}

void RabitManager::FetchControlMessages()
{
    _mgrControlAllMgrs_sptr->FetchMessage();
    _mgrControlThisMgr_sptr->FetchMessage();
}

void RabitManager::ObeyControlMessages()
{
    if (_mgrControlAllMgrs_sptr->GetShutdownManager() || _mgrControlThisMgr_sptr->GetShutdownManager())
    {
        _wakeup->RequestShutdown();
    }
    const std::pair<bool, bool> toggles{_mgrControlAllMgrs_sptr->ResetMgrStatsToggle,
                                        _mgrControlThisMgr_sptr->ResetMgrStatsToggle};
    if (toggles != _resetToggles)
    {
        _resetToggles = toggles;
        _stats.Clear();
        _missedAtReset = _wakeup->MissedTurns();
        _wakeup->TakeCounts();
        _statsResetAt = _workspace.GetClock().Monotonic();
    }
}

template <typename Work>
bool RabitManager::Guard(RabitManagerTrace::Step step, std::chrono::nanoseconds now, Work work)
{
    std::string failure;
    _progress->Begin(step, now);
    {
        RabitManagerTrace::Scope trace(_trace.get());
        if (_trace)
        {
            trace.Begin(step, _wakeup->IsTurn());
        }
        try
        {
            work();
            _progress->End();
            return true;
        }
        catch (...)
        {
            _progress->End();
            trace.Threw();
            failure = CurrentExceptionText();
        }
    }
    _progress->Failed(step, failure, _workspace.GetClock().Monotonic());
    ReportFailure(step, failure);
    return false;
}

void RabitManager::ReportFailure(RabitManagerTrace::Step step, const std::string &reason)
{
    const std::chrono::nanoseconds now = _workspace.GetClock().Monotonic();
    const bool repeated = step == ManagerProgress::Step::UnitOfWork && _lastPassFailed;
    if (repeated && now - _failureLoggedAt < FailureLogPeriod)
    {
        Increment(_failuresNotLogged);
    }
    else
    {
        const std::string count =
            repeated && _failuresNotLogged > 0
                ? " (and " + std::to_string(_failuresNotLogged) + " times since this was last logged)"
                : "";
        RabitLog::Write(RabitLogLevel::Error, "manager \"" + _name + "\": " + ManagerProgress::NameOf(step) +
                                                  " threw: " + reason + count);
        _failureLoggedAt = now;
        _failuresNotLogged = 0;
    }
    if (!repeated)
    {
        _mgrStatus_sptr->ErrorCondition = true;
        _mgrStatus_sptr->ErrorCode = ErrorCodeOf(step);
        PostStatus();
    }
}

void RabitManager::UpdateStats(std::chrono::nanoseconds now)
{
    const RabitWakeup::Counts counts = _wakeup->TakeCounts();
    Add(_stats.NumberOfWakeUpCallsWhileAsleep, counts.WhileAsleep);
    Add(_stats.NumberOfWakeUpCallsWhileAwake, counts.WhileAwake);
    _stats.NumberOfMissedTurns = _wakeup->MissedTurns() - _missedAtReset;
    _stats.TimeSinceLastStatsReset_Sec = InSeconds(now - _statsResetAt);
    _mgrStatus_sptr->ManagerStats = _stats;
}

void RabitManager::PostStatus()
{
    try
    {
        _lease->ReadQueues(_mgrStatus_sptr->Queues);
        _mgrStatus_sptr->PostMessage();
    }
    catch (...)  // only out of memory can get here: the manager goes on
    {
        RabitLog::Write(RabitLogLevel::Error,
                        "manager \"" + _name + "\" cannot post its status: " + CurrentExceptionText());
    }
}

void RabitManager::PostStatusIfDue(std::chrono::nanoseconds now)
{
    const double period = std::min(_mgrControlAllMgrs_sptr->PublishMgrStatsTime_Sec,
                                   _mgrControlThisMgr_sptr->PublishMgrStatsTime_Sec);
    if (period > 0.0 && InSeconds(now - _statusPostedAt) >= period)
    {
        _statusPostedAt = now;
        UpdateStats(now);
        PostStatus();
    }
}

}  // namespace Rabit
