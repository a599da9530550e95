// The start and the end of a node.
#include "Node.h"

#include <rabit/RabitLog.h>
#include <rabit/backfill/BackfillManager.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/recording/RecorderManager.h>
#include <rabit/transport/TransportFactory.h>

#include <unistd.h>

#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

namespace Rabit::Python
{

void Node::Start()
{
    const auto held = Use();
    Parts &parts = *held;
    const py::gil_scoped_release released;
    const std::lock_guard starting(parts.Changing);
    if (parts.IsEnding)
    {
        throw StoppedError();
    }
    if (parts.HasStarted)
    {
        throw std::runtime_error("the node `" + Name() + "` runs already");
    }
    // All that may throw comes first, and touches a copy: a start that failed leaves nothing behind.
    GatewayConfig config = _config;
    ValidateTransportName(config, AvailableTransports(), KnownTransports());
    std::unique_ptr<RecorderManager> recorder;
    if (config.Record)
    {
        recorder = std::make_unique<RecorderManager>(config, parts.Workspace);
    }
    std::unique_ptr<BackfillManager> backfill;
    if (BackfillManager::IsUsed(config))
    {
        backfill = std::make_unique<BackfillManager>(config, recorder.get(), parts.Workspace);
    }
    auto gateway =
        std::make_unique<GatewayManager>(config, TransportsOf(config, MakeTransport), parts.Workspace);
    std::promise<void> ready;
    parts.Runner = std::thread([&parts, name = Name(), isReady = ready.get_future()]() mutable
                               { RunReactor(parts, name, std::move(isReady)); });
    FleetExplorer &explorer = gateway->Explorer();
    explorer.SetOnChange([&parts] { AttachAll(parts); });
    parts.Recorder = recorder.get();
    parts.Reactor->AddManager(std::move(recorder));
    parts.Reactor->AddManager(std::move(backfill));
    parts.Reactor->AddManager(std::move(gateway));
    parts.Workspace.AddPublishSubscribeMessage(FleetMessageNameOf(config), parts.Fleet);
    parts.Reactor->SetHandleSignals(false);
    {
        // Before the managers run, since one may stop the node at once.
        const py::gil_scoped_acquire gil;
        for (PythonManager *manager : parts.Managers)
        {
            manager->Hold();
        }
        parts.Explorer = &explorer;
        parts.HasStarted = true;
    }
    ready.set_value();
}

void Node::RunReactor(Parts &parts, const std::string &name, std::future<void> isReady)
{
    try
    {
        isReady.get();
        parts.Reactor->Run();
    }
    catch (const std::exception &error)
    {
        RabitLog::Write(RabitLogLevel::Error,
                        "the node `" + name + "` cannot run: " + error.what() + "; make another one");
    }
    // The managers may have ended by themselves.
    parts.IsEnding = true;
    CloseStreams(parts);
    parts.HasEnded = true;
    parts.Ended.Notify();
}

void Node::CloseStreams(Parts &parts)
{
    {
        const std::lock_guard lock(parts.Mutex);
        for (const auto &weak : parts.Subscriptions)
        {
            if (const auto subscription = weak.lock())
            {
                subscription->Close();
            }
        }
        parts.Subscriptions.clear();
    }
    for (const auto &queue : parts.Queues)
    {
        queue->Close();
    }
    if (parts.Agreed)
    {
        parts.Agreed->Close();
    }
}

bool Node::Stop()
{
    if (!_parts || getpid() != _process)
    {
        return true;
    }
    const auto parts = _parts;
    parts->IsEnding = true;
    CloseStreams(*parts);
    if (PythonManager::IsCalledIn(parts->Workspace))
    {
        const py::gil_scoped_release released;
        parts->Reactor->ShutdownAllManagers();
        return false;
    }
    {
        const py::gil_scoped_release released;
        const std::lock_guard starting(parts->Changing);
        if (!parts->Reactor)
        {
            return true;  // another thread has just ended it
        }
        parts->Reactor->ShutdownAllManagers();
    }
    // Managers may wait for the GIL, and use the node until they have ended.
    parts->Ended.Wait(std::nullopt, [&parts] { return parts->HasEnded || !parts->Runner.joinable(); });
    const py::gil_scoped_release released;
    const std::lock_guard ending(parts->Changing);
    if (!parts->Reactor)
    {
        return true;
    }
    if (parts->Runner.joinable())
    {
        parts->Runner.join();
    }
    {
        const py::gil_scoped_acquire gil;
        _parts.reset();
    }
    const std::unique_lock lock(parts->InUse);
    parts->Explorer = nullptr;
    parts->Posted.clear();
    parts->Reactor.reset();
    return true;
}

}  // namespace Rabit::Python
