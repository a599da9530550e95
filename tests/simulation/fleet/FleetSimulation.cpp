#include "FleetSimulation.h"

#include "AirOracle.h"
#include "FleetNode.h"
#include "FleetPlan.h"
#include "FleetWorld.h"
#include "Paths.h"
#include "ScratchDirectory.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace Rabit::Sim
{

namespace
{

using namespace std::chrono_literals;

// This long after the faults have stopped, all nodes must know each other and have the latest values. All
// accepted notes must have an outcome.
constexpr Time DrainTime = 60s;
constexpr std::uint64_t MostSteps = 5'000'000;

// A planned event and its time.
struct PlannedEvent
{
    enum class Kind
    {
        Fault,
        Burst,
        Mode,
        Calm
    };
    Time At{0};
    Kind What = Kind::Calm;
    std::size_t Index = 0;
};

class FleetSimulation
{
public:
    FleetSimulation(std::uint64_t seed, std::ostream *trace);
    SeedResult Run();

private:
    // Returns the present reading of the monotonic clock of this life's process.
    Time ClockOf(std::size_t life) const { return _clocks[life].At(_world.Now); }
    void MakeAgenda();
    Time NextStep() const;
    void StepTo(Time time);
    void RunPlanned(const PlannedEvent &event);
    void OnFault(const FaultEvent &fault);
    void Start(std::size_t node, bool loseStorage);
    void Look();
    void RunUntil(Time end);
    void BeIdle();
    void OnBurst(const Burst &burst);
    void OnCalm();
    // Returns what is missing when the faults are over; empty if nothing is.
    std::string WhatIsMissing();
    std::string MissingBetween(std::size_t observer, std::size_t node);
    std::vector<Figure> Figures() const;

    const FleetPlan _plan;
    SimRandom _random;
    FleetWorld _world;
    SimulatedNetwork _network;
    NoteOracle _notes;
    MirrorOracle _mirrors;
    PresenceOracle _presence;
    Paths _paths;
    AirOracle _air;
    ScratchDirectory _scratch;
    Oracles _oracles;
    std::vector<std::unique_ptr<FleetNode>> _nodes;
    std::vector<DriftingClock> _clocks;  // by life
    std::vector<PlannedEvent> _agenda;   // by time
    std::size_t _nextPlanned = 0;
    struct FaultCounts
    {
        std::uint64_t Crashes = 0;
        std::uint64_t Leaves = 0;
        std::uint64_t StoragesLost = 0;
        std::uint64_t ClockSteps = 0;
        std::uint64_t Rates = 0;
        std::uint64_t Outages = 0;
    };
    FaultCounts _faults;
    std::uint64_t _steps = 0;
    Time _settledAt{0};
};

FleetSimulation::FleetSimulation(std::uint64_t seed, std::ostream *trace)
    : _plan(seed),
      _random(seed ^ 0x5851f42d4c957f2dULL),
      _world{.Plan = _plan, .Trace = trace, .Lives = {}, .Failure = {}},
      _network(seed),
      _notes(_world, _network, [this](std::size_t life) { return ClockOf(life); }),
      _mirrors(_world),
      _presence(_world),
      _paths(_world, _network, _presence),
      _air(_world, _network),
      _scratch(seed),
      _oracles{.Notes = _notes,
               .Mirrors = _mirrors,
               .Presence = _presence,
               .Air = _air,
               .ClockOf = [this](std::size_t life) { return ClockOf(life); }}
{
    for (std::size_t i = 0; i < _plan.Machines.size(); ++i)
    {
        _nodes.push_back(std::make_unique<FleetNode>(_world, _oracles, _network, _random, i,
                                                     _scratch.Path() / _plan.Machines[i].Name));
    }
    if (_plan.Thin)
    {
        _network.SetMedium("*", {.BytesPerSecond = _plan.Thin->BytesPerSecond});
        _world.Say(std::to_string(_plan.Machines.size()) + " nodes on " +
                   std::to_string(_plan.Thin->BytesPerSecond) + " bytes a second, budget " +
                   std::to_string(_plan.Thin->Budget.value_or(0)));
    }
    MakeAgenda();
}

void FleetSimulation::Start(std::size_t node, bool loseStorage)
{
    _nodes[node]->Start(loseStorage);
    _clocks.push_back(_nodes[node]->Clock());
}

void FleetSimulation::MakeAgenda()
{
    const auto add = [this](const auto &list, PlannedEvent::Kind kind)
    {
        for (std::size_t i = 0; i < list.size(); ++i)
        {
            _agenda.push_back({list[i].At, kind, i});
        }
    };
    add(_plan.Faults, PlannedEvent::Kind::Fault);
    add(_plan.Bursts, PlannedEvent::Kind::Burst);
    add(_plan.Modes, PlannedEvent::Kind::Mode);
    _agenda.push_back({_plan.CalmAt, PlannedEvent::Kind::Calm, 0});
    std::stable_sort(_agenda.begin(), _agenda.end(),
                     [](const PlannedEvent &a, const PlannedEvent &b) { return a.At < b.At; });
}

Time FleetSimulation::NextStep() const
{
    Time next = _network.NextEvent().value_or(Time::max());
    if (_nextPlanned < _agenda.size())
    {
        next = std::min(next, _agenda[_nextPlanned].At);
    }
    for (const auto &node : _nodes)
    {
        next = std::min(next, node->NextDue().value_or(Time::max()));
    }
    return next;
}

void FleetSimulation::StepTo(Time time)
{
    ++_steps;
    _world.Now = std::max(_world.Now, time);
    // Advances the nodes' clocks first: handlers that the network calls read them.
    for (const auto &node : _nodes)
    {
        node->FollowTime();
    }
    _network.AdvanceTo(_world.Now);
    while (_nextPlanned < _agenda.size() && _agenda[_nextPlanned].At <= _world.Now)
    {
        RunPlanned(_agenda[_nextPlanned++]);
    }
    for (const auto &node : _nodes)
    {
        node->RunDue();
    }
    _air.OnStep();
}

void FleetSimulation::RunPlanned(const PlannedEvent &event)
{
    switch (event.What)
    {
        case PlannedEvent::Kind::Fault:
            OnFault(_plan.Faults[event.Index]);
            break;
        case PlannedEvent::Kind::Burst:
            OnBurst(_plan.Bursts[event.Index]);
            break;
        case PlannedEvent::Kind::Mode:
            if (FleetNode &node = *_nodes[_plan.Modes[event.Index].Node]; node.IsAlive())
            {
                node.Crew().PostMode();
            }
            break;
        case PlannedEvent::Kind::Calm:
            OnCalm();
            break;
    }
}

void FleetSimulation::OnBurst(const Burst &burst)
{
    FleetNode &source = *_nodes[burst.Source];
    if (source.IsAlive())
    {
        _world.Say(_world.NameOf(burst.Source) + " sends " + std::to_string(burst.Count) + " notes to " +
                   (burst.Destination == Burst::ToAll ? "all" : _world.NameOf(burst.Destination)) +
                   " from note " + std::to_string(_notes.Notes()));
        source.Crew().Send(burst.Destination, burst.Count);
    }
}

void FleetSimulation::OnFault(const FaultEvent &fault)
{
    FleetNode &node = *_nodes[fault.A];
    static constexpr const char *Names[] = {"weather", "cut",    "cut ends",   "crash",
                                            "leave",   "start",  "clock step", "stall",
                                            "rate",    "outage", "outage ends"};
    _world.Say(std::string(Names[static_cast<int>(fault.Kind)]) + " " + _world.NameOf(fault.A) + " " +
               _world.NameOf(fault.B) + " " + std::to_string(fault.Amount) +
               (fault.LoseStorage ? " storage lost" : ""));
    switch (fault.Kind)
    {
        case FaultKind::Weather:
            _paths.SetWeather(fault.A, fault.B, fault.Weather);
            break;
        case FaultKind::CutStart:
            _paths.Cut(fault.A, fault.B);
            break;
        case FaultKind::CutEnd:
            _paths.EndCut(fault.A, fault.B);
            break;
        case FaultKind::Crash:
        case FaultKind::Leave:
            if (node.IsAlive())
            {
                ++(fault.Kind == FaultKind::Crash ? _faults.Crashes : _faults.Leaves);
                fault.Kind == FaultKind::Crash ? node.Crash() : node.Leave();
            }
            break;
        case FaultKind::Start:
            if (!node.IsAlive())
            {
                _faults.StoragesLost += fault.LoseStorage ? 1 : 0;
                Start(fault.A, fault.LoseStorage);
            }
            break;
        case FaultKind::ClockStep:
            ++_faults.ClockSteps;
            node.StepWallClock(fault.Amount);
            break;
        case FaultKind::Stall:
            if (node.IsAlive())
            {
                node.Crew().StallUntil(_world.Now + Time(fault.Amount));
            }
            break;
        case FaultKind::Rate:
            ++_faults.Rates;
            _network.SetMedium("*", {.BytesPerSecond = static_cast<std::uint64_t>(fault.Amount)});
            _air.OnRate(static_cast<std::uint64_t>(fault.Amount));
            break;
        case FaultKind::Outage:
            ++_faults.Outages;
            _paths.CutAll();
            _air.OnOutage();
            break;
        case FaultKind::OutageEnd:
            _paths.EndCutOfAll();
            _air.OnOutageEnd();
            break;
    }
}

void FleetSimulation::OnCalm()
{
    _world.Say("calm");
    for (std::size_t i = 0; i < _nodes.size(); ++i)
    {
        for (std::size_t j = 0; j < _nodes.size(); ++j)
        {
            _paths.SetWeather(i, j, SimulatedFaults());
        }
        if (_nodes[i]->IsAlive())
        {
            _nodes[i]->Crew().Hurry();
        }
        else if (!_plan.Machines[i].NeverThere)
        {
            Start(i, false);
            _nodes[i]->Crew().Hurry();
        }
    }
}

std::string FleetSimulation::MissingBetween(std::size_t observer, std::size_t node)
{
    const std::size_t life = _nodes[node]->CurrentLife();
    const std::size_t seenBy = _nodes[observer]->CurrentLife();
    const std::string who = _world.NameOf(observer) + " of " + _world.NameOf(node);
    if (!PresenceOracle::IsUp(_nodes[observer]->Crew().Fleet(), _world.NameOf(node)))
    {
        return who + ": is not shown as UP";
    }
    if (!_mirrors.IsUpToDate(MirrorOracle::Topic::Mode, seenBy, life))
    {
        return who + ": has not the latest mode";
    }
    const Time onTheWay = _plan.Thin ? _plan.Thin->PoseAge : Time(100ms);
    if (_mirrors.AgeOf(MirrorOracle::Topic::Track, seenBy, life) >
        _plan.Machines[node].TrackPeriod + onTheWay)
    {
        return who + ": has no recent track";
    }
    return "";
}

std::string FleetSimulation::WhatIsMissing()
{
    std::vector<bool> alive;
    for (const auto &node : _nodes)
    {
        alive.push_back(node->IsAlive());
    }
    for (std::size_t i = 0; i < _nodes.size(); ++i)
    {
        for (std::size_t j = 0; j < _nodes.size(); ++j)
        {
            if (i == j || !alive[i] || !alive[j])
            {
                continue;
            }
            const std::string missing = MissingBetween(i, j);
            if (!missing.empty())
            {
                return missing;
            }
        }
    }
    const std::size_t undrained = _notes.Undrained(alive);
    return undrained == 0 ? "" : std::to_string(undrained) + " notes have no outcome";
}

// Reports the values that managers see now to the oracle.
void FleetSimulation::Look()
{
    for (std::size_t i = 0; i < _nodes.size(); ++i)
    {
        if (_notes.HasLargePending(i))
        {
            _air.OnLargeNotes(i);
        }
        for (std::size_t j = 0; j < _nodes.size(); ++j)
        {
            if (i != j && _nodes[i]->IsAlive() && _nodes[j]->IsAlive())
            {
                _air.OnNewestTrack(i, j,
                                   _mirrors.AgeOf(MirrorOracle::Topic::Track, _nodes[i]->CurrentLife(),
                                                  _nodes[j]->CurrentLife()));
            }
        }
    }
}

void FleetSimulation::RunUntil(Time end)
{
    while (_world.Failure.empty() && _world.Now < end)
    {
        StepTo(std::min(NextStep(), end));
    }
}

// Runs the fleet idle: no node has anything to send.
void FleetSimulation::BeIdle()
{
    for (const auto &node : _nodes)
    {
        node->Crew().FallSilent();
    }
    RunUntil(_world.Now + 10s);
    _air.BeginIdle();
    // Long enough for twelve of DDS's announcements, four with a budget: one more, if the time begins just
    // before one, must not decide the result.
    RunUntil(_world.Now + 120s);
    if (_world.Failure.empty())
    {
        _air.EndIdle();
    }
}

SeedResult FleetSimulation::Run()
{
    for (std::size_t i = 0; i < _nodes.size(); ++i)
    {
        if (!_plan.Machines[i].NeverThere)
        {
            Start(i, false);
        }
    }
    Time nextLook{0};
    while (_world.Failure.empty())
    {
        StepTo(NextStep());
        if (_steps > MostSteps)
        {
            _world.Fail(10, "a node asks to be run without end");
        }
        if (_world.Now < nextLook)
        {
            continue;
        }
        nextLook = _world.Now + 100ms;
        Look();
        if (_world.Now < _plan.CalmAt + 1s || _nextPlanned < _agenda.size())
        {
            continue;
        }
        const std::string missing = WhatIsMissing();
        if (missing.empty())
        {
            break;
        }
        _world.Say("missing: " + missing);
        if (_world.Now > _plan.CalmAt + DrainTime)
        {
            _world.Fail(11, "60 s after the faults stopped: " + missing);
        }
    }
    _settledAt = _world.Now;
    if (_plan.Thin && _world.Failure.empty())
    {
        BeIdle();
    }
    for (const auto &node : _nodes)
    {
        if (node->IsAlive())
        {
            node->Crew().EmptyQueue();
        }
    }
    _notes.CheckDelivered();
    return {_world.Failure, Figures()};
}

std::vector<Figure> FleetSimulation::Figures() const
{
    const NoteOracle::Counts &notes = _notes.Total();
    const SimulatedTraffic traffic = _network.Traffic();
    return {{"steps", _steps},
            {"notes accepted", notes.Accepted},
            {"refused (full)", notes.RefusedFull},
            {"refused (node not known)", notes.RefusedUnknown},
            {"sent to all", notes.SentToAll},
            {"delivered", notes.Delivered},
            {"expired", notes.Expired},
            {"in doubt", notes.InDoubt},
            {"given up in silence", notes.GivenUp},
            {"delivered again (opted in)", notes.DeliveredAgain},
            {"large notes delivered", notes.LargeDelivered},
            {"tracks seen", _mirrors.Fetched(MirrorOracle::Topic::Track)},
            {"modes seen", _mirrors.Fetched(MirrorOracle::Topic::Mode)},
            {"nodes shown as STALE", _presence.Stale()},
            {"nodes shown as LOST", _presence.Lost()},
            {"datagrams", traffic.Sent},
            {"datagrams lost", traffic.Lost},
            {"datagrams duplicated", traffic.Duplicated},
            {"cuts", _paths.Cuts()},
            {"crashes", _faults.Crashes},
            {"orderly ends", _faults.Leaves},
            {"storages lost", _faults.StoragesLost},
            {"clock steps", _faults.ClockSteps},
            {"longest until all is well",
             static_cast<std::uint64_t>(std::max(_settledAt - _plan.CalmAt, Time(0)).count()),
             Figure::Kind::Largest},
            {"longest until UP over a thin medium", _air.LongestUntilUp(), Figure::Kind::Largest},
            {"most said over a thin medium, of what would do", _air.MostSaid(), Figure::Kind::LargestPercent},
            {"oldest track that came over a thin medium", _air.LongestTrackAge(), Figure::Kind::Largest}};
}

}  // namespace

SeedResult RunFleetSeed(std::uint64_t seed, std::ostream *trace)
{
    return FleetSimulation(seed, trace).Run();
}

}  // namespace Rabit::Sim
