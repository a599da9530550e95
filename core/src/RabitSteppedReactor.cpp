#include <rabit/RabitSteppedReactor.h>

#include "ManagerLease.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace Rabit
{

RabitSteppedReactor::RabitSteppedReactor(RabitWorkspace &workspace) : _workspace(workspace) {}

RabitSteppedReactor::~RabitSteppedReactor()
{
    Stop();
    for (const Entry &entry : _entries)
    {
        entry.Manager->EndHandlers();
    }
    while (!_entries.empty())
    {
        _entries.pop_back();
    }
}

void RabitSteppedReactor::AddManager(std::unique_ptr<RabitManager> manager)
{
    if (!manager)
    {
        return;
    }
    if (&manager->GetWorkspace() != &_workspace)
    {
        throw std::invalid_argument("manager \"" + manager->GetManagerName() +
                                    "\" belongs to another workspace than its reactor");
    }
    manager->_lease->AddManagerName();
    _entries.emplace_back();
    _entries.back().Manager = std::move(manager);
    if (_started)
    {
        _entries.back().Manager->PrepareRun();
        StartEntry(_entries.back());
    }
}

void RabitSteppedReactor::Start()
{
    if (_started)
    {
        throw std::logic_error("the reactor is started already");
    }
    _started = true;
    _anyEnded = _entries.empty();
    for (Entry &entry : _entries)
    {
        entry.Manager->PrepareRun();
    }
    for (Entry &entry : _entries)
    {
        StartEntry(entry);
    }
}

void RabitSteppedReactor::StartEntry(Entry &entry)
{
    entry.Running = true;
    entry.FirstPass = true;
    if (entry.Manager->StartupStep())
    {
        entry.Manager->BeginSleepStep();
        entry.Manager->_wakeup->BeginTurns(entry.Manager->_sleepBegan);
    }
    else
    {
        EndEntry(entry);
    }
}

void RabitSteppedReactor::EndEntry(Entry &entry)
{
    entry.Manager->ShutdownStep();
    entry.Running = false;
    _anyEnded = true;
}

std::chrono::nanoseconds RabitSteppedReactor::DueOf(const Entry &entry) const
{
    const RabitManager &manager = *entry.Manager;
    if (entry.FirstPass)
    {
        return manager._sleepBegan;
    }
    const std::chrono::nanoseconds due = manager.NextDue();
    const bool noSleep = due == manager._sleepBegan && !manager._wakeup->MaySleep() &&
                         !manager._wakeup->IsSignalled() && !manager._wakeup->IsShutdownRequested();
    return noSleep ? due + NoSleepStep : due;
}

std::optional<std::chrono::nanoseconds> RabitSteppedReactor::NextDue() const
{
    std::optional<std::chrono::nanoseconds> next;
    const std::chrono::nanoseconds now = _workspace.GetClock().Monotonic();
    for (const Entry &entry : _entries)
    {
        if (entry.Running)
        {
            const std::chrono::nanoseconds due = std::max(now, DueOf(entry));
            next = next ? std::min(*next, due) : due;
        }
    }
    return next;
}

int RabitSteppedReactor::RunDue()
{
    int passes = 0;
    bool again = _started;
    std::chrono::nanoseconds now = _workspace.GetClock().Monotonic();
    while (again)
    {
        again = false;
        // By index: a unit of work may add managers.
        for (std::size_t i = 0; i < _entries.size(); ++i)
        {
            Entry &entry = _entries[i];
            if (!entry.Running || DueOf(entry) > now)
            {
                continue;
            }
            again = true;
            if (RunPass(entry, now) && ++passes > MaxPassesAtOneMoment)
            {
                throw std::runtime_error("managers wake each other for ever; the last one was \"" +
                                         entry.Manager->GetManagerName() + "\"");
            }
            now = std::max(now, entry.Manager->_sleepBegan);  // read at the end of the pass
        }
    }
    if (std::exchange(_anyEnded, false))
    {
        LeaveIfAllEnded();
    }
    return passes;
}

bool RabitSteppedReactor::RunPassOf(const RabitManager &manager, bool isTurn)
{
    for (Entry &entry : _entries)
    {
        if (entry.Manager.get() == &manager && entry.Running)
        {
            const bool ran = RunPass(entry, _workspace.GetClock().Monotonic(), isTurn);
            LeaveIfAllEnded();
            return ran;
        }
    }
    return false;
}

bool RabitSteppedReactor::RunPass(Entry &entry, std::chrono::nanoseconds now, std::optional<bool> isTurn)
{
    if (!std::exchange(entry.FirstPass, false))
    {
        entry.Manager->EndSleepStep(now);
    }
    if (isTurn)
    {
        entry.Manager->_wakeup->SetTurn(*isTurn);
    }
    if (!entry.Manager->CycleStep())
    {
        EndEntry(entry);
        return false;
    }
    entry.Manager->BeginSleepStep();
    return true;
}

int RabitSteppedReactor::RunUntil(ManualClock &clock, std::chrono::nanoseconds until)
{
    if (&_workspace.GetClock() != &clock)
    {
        throw std::invalid_argument("the clock is not that of the reactor's workspace");
    }
    int passes = 0;
    for (auto due = NextDue(); due && *due <= until; due = NextDue())
    {
        clock.AdvanceTo(*due);
        passes += RunDue();
    }
    clock.AdvanceTo(until);
    return passes;
}

int RabitSteppedReactor::RunFor(ManualClock &clock, std::chrono::nanoseconds duration)
{
    return RunUntil(clock, clock.Monotonic() + duration);
}

bool RabitSteppedReactor::IsRunning() const
{
    return std::any_of(_entries.begin(), _entries.end(), [](const Entry &entry) { return entry.Running; });
}

void RabitSteppedReactor::Stop()
{
    for (std::size_t i = 0; i < _entries.size(); ++i)
    {
        if (_entries[i].Running)
        {
            _entries[i].Manager->ShutdownManager();
            EndEntry(_entries[i]);
        }
    }
    LeaveIfAllEnded();
}

// As at the end of RabitReactor::Run.
void RabitSteppedReactor::LeaveIfAllEnded()
{
    if (!_started || IsRunning())
    {
        return;
    }
    _started = false;
    std::vector<ManagerLease *> leases;
    for (const Entry &entry : _entries)
    {
        entry.Manager->FinishRun();
        leases.push_back(entry.Manager->_lease.get());
    }
    ManagerLease::Leave(_workspace, leases);
}

}  // namespace Rabit
