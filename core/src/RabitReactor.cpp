#include <rabit/RabitReactor.h>

#include "HangWatch.h"
#include "ManagerLease.h"
#include "ManagerProgress.h"
#include "ShutdownSignals.h"

#include <rabit/RabitLog.h>
#include <rabit/StandardDescriptors.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace Rabit
{

struct RabitReactor::State
{
    explicit State(RabitWorkspace &workspace) : Workspace(workspace) {}

    void ShutdownAll()
    {
        const std::lock_guard<std::mutex> lock(Mutex);
        for (const auto &manager : Managers)
        {
            manager->ShutdownManager();
        }
    }
    void StartAll(ShutdownSignals &signals);
    void AwaitEnd(ShutdownSignals &signals);
    void JoinAll();
    void Leave();

    RabitWorkspace &Workspace;
    // Guards the list of managers, which another thread may iterate over to shut them down.
    std::mutex Mutex;
    std::vector<std::unique_ptr<RabitManager>> Managers;
    std::chrono::nanoseconds Patience = std::chrono::seconds(5);
    bool HandleSignals = true;
    std::atomic<bool> Running{false};
    std::atomic<std::size_t> Ended{0};
};

RabitReactor::RabitReactor() : RabitReactor(*RabitWorkspace::GetWorkspace()) {}

RabitReactor::RabitReactor(RabitWorkspace &workspace) : _state(std::make_unique<State>(workspace))
{
    OpenStandardDescriptors();
}

RabitReactor::~RabitReactor()
{
    if (!_state)
    {
        return;
    }
    _state->ShutdownAll();
    _state->JoinAll();
    // Handlers that call a manager are disconnected before any manager is destroyed.
    for (const auto &manager : _state->Managers)
    {
        manager->EndHandlers();
    }
    while (!_state->Managers.empty())
    {
        _state->Managers.pop_back();
    }
}

RabitReactor::RabitReactor(RabitReactor &&other) noexcept = default;

RabitReactor &RabitReactor::operator=(RabitReactor &&other) noexcept
{
    if (this != &other)
    {
        RabitReactor former(std::move(*this));
        _state = std::move(other._state);
    }
    return *this;
}

RabitReactor::State &RabitReactor::StateOrThrow() const
{
    if (!_state)
    {
        throw std::logic_error("a reactor that was moved from was used");
    }
    return *_state;
}

void RabitReactor::AddManager(std::unique_ptr<RabitManager> manager)
{
    State &state = StateOrThrow();
    if (!manager)
    {
        return;
    }
    if (&manager->GetWorkspace() != &state.Workspace)
    {
        throw std::invalid_argument("manager \"" + manager->GetManagerName() +
                                    "\" belongs to another workspace than its reactor");
    }
    if (state.Running.load())
    {
        throw std::logic_error("manager \"" + manager->GetManagerName() +
                               "\" was added to a reactor that runs");
    }
    manager->_lease->AddManagerName();
    const std::lock_guard<std::mutex> lock(state.Mutex);
    state.Managers.push_back(std::move(manager));
}

void RabitReactor::State::StartAll(ShutdownSignals &signals)
{
    // All names are registered again before the first manager runs.
    for (const auto &manager : Managers)
    {
        manager->PrepareRun();
    }
    for (const auto &manager : Managers)
    {
        RabitManager *const started = manager.get();
        started->_thread = std::thread(
            [this, started, &signals]
            {
                started->ThreadMain();
                Ended.fetch_add(1);
                signals.Wake();
            });
    }
}

void RabitReactor::State::AwaitEnd(ShutdownSignals &signals)
{
    bool told = false;
    HangWatch watch(Managers.size(), Patience);
    while (Ended.load() < Managers.size())
    {
        signals.WaitFor(Patience / 2);
        if (signals.SignalCame() && !std::exchange(told, true))
        {
            RabitLog::Write(RabitLogLevel::Info, "a signal asks for shutdown");
            ShutdownAll();
        }
        const HangWatch::Clock::time_point now = HangWatch::Clock::now();
        for (std::size_t i = 0; i < Managers.size(); ++i)
        {
            const RabitManager &manager = *Managers[i];
            const auto trouble =
                manager._progress->Trouble(manager._name, *manager._wakeup, Workspace.GetClock().Monotonic());
            watch.Look(i, manager._name, manager._loopActive.load() && manager._wakeup->IsShutdownRequested(),
                       trouble ? trouble->Step.c_str() : manager._progress->StepName(),
                       trouble ? trouble->HangsFor : std::chrono::nanoseconds(0), now);
        }
    }
}

void RabitReactor::State::JoinAll()
{
    for (const auto &manager : Managers)
    {
        if (manager->_thread.joinable())
        {
            manager->_thread.join();
        }
    }
}

void RabitReactor::State::Leave()
{
    std::vector<ManagerLease *> leases;
    for (const auto &manager : Managers)
    {
        manager->FinishRun();
        leases.push_back(manager->_lease.get());
    }
    ManagerLease::Leave(Workspace, leases);
}

void RabitReactor::Run()
{
    State &state = StateOrThrow();
    if (state.Running.exchange(true))
    {
        throw std::logic_error("the reactor is running already");
    }
    state.Ended.store(0);
    {
        ShutdownSignals signals(state.HandleSignals);
        try
        {
            state.StartAll(signals);
        }
        catch (...)
        {
            state.ShutdownAll();
            state.JoinAll();
            state.Leave();
            state.Running.store(false);
            throw;
        }
        state.AwaitEnd(signals);
        state.JoinAll();
    }
    state.Leave();
    state.Running.store(false);
}

void RabitReactor::ShutdownAllManagers()
{
    StateOrThrow().ShutdownAll();
}

void RabitReactor::SetPatience(std::chrono::nanoseconds patience)
{
    StateOrThrow().Patience = std::max<std::chrono::nanoseconds>(patience, std::chrono::milliseconds(1));
}

void RabitReactor::SetHandleSignals(bool handle)
{
    StateOrThrow().HandleSignals = handle;
}

}  // namespace Rabit
