#pragma once

#include "Crew.h"
#include "FleetWorld.h"

#include <DriftingClock.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/simulated/SimulatedKeys.h>
#include <rabit/simulated/SimulatedNetwork.h>

#include <filesystem>
#include <memory>
#include <optional>

namespace Rabit::Sim
{

// A machine with a wall clock and perhaps a counter file, on which a process with a gateway and a crew starts
// and ends.
class FleetNode
{
public:
    // `stateDirectory` is its own; it need not exist.
    FleetNode(FleetWorld &world, const Oracles &oracles, SimulatedNetwork &network, SimRandom &random,
              std::size_t index, std::filesystem::path stateDirectory);
    ~FleetNode();

    bool IsAlive() const { return _process != nullptr; }
    std::size_t CurrentLife() const { return _life; }
    Sim::Crew &Crew() { return *_process->Crew; }
    const DriftingClock &Clock() const { return _clock; }

    void Start(bool loseStorage);
    // As by SIGKILL.
    void Crash();
    void Leave();
    void StepWallClock(std::int64_t seconds);

    // When, in true time, its process wants to run next.
    std::optional<Time> NextDue() const;
    // Lets the clocks of the process show the present.
    void FollowTime();
    void RunDue();

private:
    struct Process
    {
        Process(double gps, Time monotonic)
            : Clock(std::make_shared<ManualClock>(gps, monotonic)), Workspace(Clock), Reactor(Workspace)
        {
        }
        std::shared_ptr<ManualClock> Clock;
        RabitWorkspace Workspace;
        RabitSteppedReactor Reactor;
        Sim::Crew *Crew = nullptr;  // the reactor's
    };

    GatewayConfig MakeConfig();
    void End();

    FleetWorld &_world;
    const Oracles &_oracles;
    SimulatedNetwork &_network;
    SimulatedKeys _keys;
    SimRandom &_random;
    const std::size_t _index;
    const std::filesystem::path _stateDirectory;
    double _wallSteps = 0;  // seconds
    std::size_t _life = 0;
    DriftingClock _clock;
    std::unique_ptr<Process> _process;
};

}  // namespace Rabit::Sim
