#include "FleetNode.h"

#include <rabit/gateway/GatewayManager.h>
#include <rabit/simulated/SimulatedTransport.h>

#include <system_error>
#include <utility>

namespace Rabit::Sim
{

namespace
{

constexpr double GpsAtStart = 1.4e9;

}  // namespace

FleetNode::FleetNode(FleetWorld &world, const Oracles &oracles, SimulatedNetwork &network, SimRandom &random,
                     std::size_t index, std::filesystem::path stateDirectory)
    : _world(world),
      _oracles(oracles),
      _network(network),
      _keys(network),
      _random(random),
      _index(index),
      _stateDirectory(std::move(stateDirectory))
{
}

FleetNode::~FleetNode() = default;

GatewayConfig FleetNode::MakeConfig()
{
    const MachinePlan &plan = _world.Plan.Machines[_index];
    GatewayConfig config;
    config.Node = plan.Name;
    config.Lease = _world.Plan.Lease;
    config.StateDir = plan.KeepsCounter ? _stateDirectory.string() : "";
    config.Publish.push_back({.Message = "Track", .Type = "Rabit::Sim::Track", .Qos = QosProfile::Telemetry});
    config.Publish.push_back({.Message = "Mode", .Type = "Rabit::Sim::Mode"});
    config.Subscribe.push_back({.Message = "Track", .Type = "Rabit::Sim::Track"});
    config.Subscribe.push_back({.Message = "Mode", .Type = "Rabit::Sim::Mode"});
    config.Accept.push_back({.Queue = Crew::Queue, .Types = {"Rabit::Sim::Note"}});
    config.Send = plan.Send;
    if (_world.Plan.HasKeys)
    {
        config.Security.emplace().Member = _keys.Member(plan.Name);
    }
    if (_world.Plan.Thin && _world.Plan.Thin->Budget)
    {
        config.Radio.Budget = static_cast<double>(*_world.Plan.Thin->Budget);
    }
    return config;
}

void FleetNode::Start(bool loseStorage)
{
    if (loseStorage)
    {
        std::error_code ignored;
        std::filesystem::remove_all(_stateDirectory, ignored);
    }
    _life = _world.Lives.size();
    _world.Lives.push_back({.Node = _index});
    _oracles.Notes.OnEpoch(_index);
    _oracles.Presence.OnStarted(_index);
    _oracles.Air.OnStarted(_index);
    _clock = {.StartedAt = _world.Now,
              .Offset = Time(_random.Between(0, 1'000'000'000'000'000)),
              .DriftPpm = _world.Plan.Machines[_index].DriftPpm};
    const double wall = GpsAtStart + std::chrono::duration<double>(_world.Now).count() + _wallSteps;
    _process = std::make_unique<Process>(wall, _clock.At(_world.Now));
    auto crew = std::make_unique<Sim::Crew>(_process->Workspace, _world, _oracles, _random, _life);
    _process->Crew = crew.get();
    _process->Reactor.AddManager(std::move(crew));
    _process->Reactor.AddManager(
        std::make_unique<GatewayManager>(MakeConfig(), std::make_shared<SimulatedTransport>(_network),
                                         _process->Workspace, [this] { return _random.Next(); }));
    _process->Reactor.Start();
}

void FleetNode::End()
{
    Crew().EmptyQueue();
    _world.Lives[_life].Ended = true;
    _world.Lives[_life].EndedAt = _world.Now;
    _oracles.Notes.OnEpoch(_index);
    _oracles.Presence.OnEnded(_index);
    _oracles.Air.OnEnded(_index);
}

void FleetNode::Crash()
{
    End();
    _network.CrashNode(_world.NameOf(_index));
    _process.reset();
}

void FleetNode::Leave()
{
    _world.Lives[_life].Leaving = true;
    _process->Reactor.Stop();
    _oracles.Notes.OnLeft(_life);
    End();
    _process.reset();
}

void FleetNode::StepWallClock(std::int64_t seconds)
{
    _wallSteps += static_cast<double>(seconds);
    if (_process)
    {
        _process->Clock->SetGpsTimeSeconds(_process->Clock->GpsTimeSeconds() + static_cast<double>(seconds));
    }
}

std::optional<Time> FleetNode::NextDue() const
{
    const std::optional<Time> due = _process ? _process->Reactor.NextDue() : std::nullopt;
    return due ? std::optional<Time>(std::max(_clock.TrueTimeOf(*due), _world.Now)) : std::nullopt;
}

void FleetNode::FollowTime()
{
    if (_process)
    {
        _process->Clock->AdvanceTo(_clock.At(_world.Now));
    }
}

void FleetNode::RunDue()
{
    if (_process)
    {
        _process->Reactor.RunDue();
    }
}

}  // namespace Rabit::Sim
