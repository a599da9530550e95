// The cost to a manager of recording its steps: a unit of work that reads the clock twice, fetches a pose,
// takes a command and posts its state. It runs without (0) and with (1) its recording. The time is that of
// the manager's own thread; the recorder's thread comes on top.
#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/recording/RecorderManager.h>

#include <benchmark/benchmark.h>

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "uav.idl.h"

namespace
{

class Follower : public Rabit::RabitManager
{
public:
    explicit Follower(Rabit::RabitWorkspace &workspace) : RabitManager("Follower", workspace)
    {
        AddPublishSubscribeMessage("Pose", _pose);
        AddPublishSubscribeMessage("MissionState", _state);
    }
    void ExecuteUnitOfWork() override
    {
        benchmark::DoNotOptimize(GetWorkspace().GetClock().Monotonic());
        _pose->FetchMessage();
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            ++_state->commands;
        }
        _state->floor_m = static_cast<float>(_pose->GetAgeSeconds());
        _state->PostMessage();
    }

private:
    const std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    const std::shared_ptr<Uav::MissionState> _state = std::make_shared<Uav::MissionState>();
};

void UnitOfWork(benchmark::State &state)
{
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("rabit_bench_steps_" + std::to_string(::getpid()));
    {
        const auto clock = std::make_shared<Rabit::ManualClock>(1.4e9);
        Rabit::RabitWorkspace workspace(clock);
        Rabit::GatewayConfig config;
        config.Node = "uav1";
        config.Record.emplace();
        config.Record->Folder = folder.string();
        config.Record->Free = 0;
        config.Record->Except = {"*"};
        if (state.range(0) == 1)
        {
            config.Record->Steps = {"Follower"};
        }
        Rabit::RabitSteppedReactor reactor(workspace);
        reactor.AddManager(std::make_unique<Rabit::RecorderManager>(config, workspace));
        auto manager = std::make_unique<Follower>(workspace);
        const Rabit::RabitManager &follower = *manager;
        reactor.AddManager(std::move(manager));
        const auto pose = std::make_shared<Uav::Pose>();
        workspace.AddPublishSubscribeMessage("Pose", pose);
        reactor.Start();
        for (auto _ : state)
        {
            clock->Advance(std::chrono::milliseconds(100));
            pose->PostMessage();
            workspace.AddMessageToQueue("Follower", std::make_shared<Uav::Goto>());
            reactor.RunPassOf(follower, true);
        }
        reactor.Stop();
    }
    std::filesystem::remove_all(folder);
}
BENCHMARK(UnitOfWork)->Arg(0)->Arg(1);

}  // namespace

BENCHMARK_MAIN();
