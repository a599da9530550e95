#include "ManagerLease.h"

#include <rabit/RabitLog.h>
#include <rabit/RabitManager.h>

#include <cstdio>

// Warnings of settings that are most likely mistakes. The loop looks after the first unit of work, and after
// each in which the settings changed. So a program may make its settings in any order.
namespace Rabit
{
namespace
{

std::string Seconds(double seconds)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.3g s", seconds);
    return text;
}

}  // namespace

void RabitManager::WarnOfSettings()
{
    _settingsChanged.store(false);
    WarnOfWakeupsBetweenTurns();
    WarnOfQueuesWithoutWakeup();
}

void RabitManager::WarnOfWakeupsBetweenTurns()
{
    if (_warnedOfPeriod || _betweenTurnsIsChosen.load() || GetPeriodSec() <= 0.0)
    {
        return;
    }
    const std::string wakeup = NameOfFirstWakeup();
    if (wakeup.empty())
    {
        return;
    }
    _warnedOfPeriod = true;
    RabitLog::Write(
        RabitLogLevel::Warning,
        "manager \"" + _name + "\" is not woken between turns: its wake-up on " + wakeup +
            " waits for the next turn of its period of " + Seconds(GetPeriodSec()) +
            "; call SetWakeupBetweenTurns(true), or SetWakeupBetweenTurns(false) if that is meant");
}

std::string RabitManager::NameOfFirstWakeup()
{
    const auto quoted = [](const char *what, const std::string &name)
    { return name.empty() ? "a " + std::string(what) : std::string(what) + " \"" + name + "\""; };
    const std::lock_guard<std::mutex> lock(_wakeupsMutex);
    const auto controls = ControlGlobals();
    for (const MessageWakeup &wakeup : _messageWakeups)
    {
        if (wakeup.Global != controls.first && wakeup.Global != controls.second &&
            wakeup.Connection.IsConnected())
        {
            return quoted("message", _lease->NameOf(wakeup.Global.get()));
        }
    }
    ForgetEndedQueueWakeups();
    for (const QueueWakeup &wakeup : _queueWakeups)
    {
        if (wakeup.Event == QueueEvent::Settled)
        {
            return "a receipt";
        }
        if (wakeup.Queue != _mgrMessageQueue_sptr.get() || wakeup.Event != QueueEvent::Enqueued)
        {
            return quoted("queue", _lease->NameOfQueue(wakeup.Queue));
        }
    }
    return "";
}

void RabitManager::WarnOfQueuesWithoutWakeup()
{
    if (_warnedOfQueues || _delayIsChosen.load() || GetPeriodSec() > 0.0)
    {
        return;
    }
    const std::vector<std::string> queues = _lease->QueuesWithoutHandlers();
    if (queues.empty())
    {
        return;
    }
    _warnedOfQueues = true;
    std::string names;
    for (const std::string &name : queues)
    {
        names += (names.empty() ? "\"" : ", \"") + name + "\"";
    }
    RabitLog::Write(RabitLogLevel::Warning,
                    "manager \"" + _name + "\" is not woken by its queue " + names +
                        ": messages wait there for up to " + Seconds(GetWakeupTimeDelaySec()) +
                        "; call WakeUpManagerOnEnqueue, or SetWakeupTimeDelaySec if that is meant");
}

// A manager that does not sleep may block in its unit of work, and one whose period is longer may take that
// time.
void RabitManager::WarnOfLongWork(std::chrono::nanoseconds took)
{
    const double took_Sec = std::chrono::duration<double>(took).count();
    if (_warnedOfLongWork || !_wakeup->MaySleep() || took_Sec < GetPeriodSec())
    {
        return;
    }
    _warnedOfLongWork = true;
    RabitLog::Write(RabitLogLevel::Warning,
                    "manager \"" + _name + "\": a unit of work took " + Seconds(took_Sec) +
                        "; wake-ups, its queue and a shutdown waited for it: work in smaller pieces, or "
                        "SetWakeupTimeDelaySec(0) for a manager that waits for input itself");
}

}  // namespace Rabit
