#include "FleetPlan.h"

#include <algorithm>

namespace Rabit::Sim
{

namespace
{

using namespace std::chrono_literals;

SimulatedFaults DrawWeather(SimRandom &random)
{
    SimulatedFaults weather;
    weather.Loss = random.Chance(0.4) ? 0 : random.Chance(0.7) ? random.Unit() * 0.2 : random.Unit() * 0.6;
    weather.Duplicate = random.Chance(0.5) ? 0 : random.Unit() * 0.2;
    weather.Delay = random.LogBetween(100us, 400ms);
    weather.Jitter = random.Chance(0.3) ? 0ms : Time(random.Between(0, 2 * weather.Delay.count()));
    weather.Straggle = random.Chance(0.6) ? 0 : random.Unit() * 0.03;
    weather.StraggleDelay = 90s;
    return weather;
}

MachinePlan DrawMachine(SimRandom &random, std::size_t index, bool mayBeAbsent)
{
    MachinePlan machine;
    machine.Name.assign(1, 'n');
    machine.Name += std::to_string(index);
    machine.NeverThere = mayBeAbsent && random.Chance(0.15);
    machine.KeepsCounter = random.Chance(0.5);
    machine.DriftPpm = random.Chance(0.5) ? 0 : random.Between(-500, 500);
    machine.QueueCapacity = static_cast<int>(random.LogBetween(1, 300));
    machine.ConsumePeriod = random.Chance(0.7) ? random.LogBetween(1ms, 20ms) : random.LogBetween(20ms, 2s);
    machine.TrackPeriod = random.LogBetween(50ms, 2s);
    return machine;
}

SendRule DrawRule(SimRandom &random, const std::string &destination)
{
    SendRule rule;
    rule.To = destination;
    rule.Queue = "Notes";
    rule.Capacity = static_cast<std::size_t>(random.LogBetween(1, 300));
    rule.Expire = random.Chance(0.5)
                      ? 0ms
                      : std::chrono::duration_cast<std::chrono::milliseconds>(random.LogBetween(50ms, 60s));
    rule.Window = static_cast<std::size_t>(random.LogBetween(1, 256));
    rule.RedeliverInDoubt = random.Chance(0.3);
    return rule;
}

void AddCut(FleetPlan &plan, std::size_t a, std::size_t b, Time from, Time to)
{
    plan.Faults.push_back({.At = from, .Kind = FaultKind::CutStart, .A = a, .B = b});
    plan.Faults.push_back({.At = to, .Kind = FaultKind::CutEnd, .A = a, .B = b});
}

void AddFault(FleetPlan &plan, SimRandom &random)
{
    const std::size_t count = plan.Machines.size();
    const std::size_t a = random.Index(count);
    const std::size_t b = (a + 1 + random.Index(count - 1)) % count;
    const Time at = random.Between(0ms, plan.CalmAt);
    const double kind = random.Unit();
    if (kind < 0.25)
    {
        plan.Faults.push_back(
            {.At = at, .Kind = FaultKind::Weather, .A = a, .B = b, .Weather = DrawWeather(random)});
    }
    else if (kind < 0.5)
    {
        const Time end = std::min(at + random.LogBetween(1s, 120s), plan.CalmAt);
        AddCut(plan, a, b, at, end);
        if (random.Chance(0.6))
        {
            AddCut(plan, b, a, at, end);
        }
    }
    else if (plan.Machines[a].NeverThere)
    {
        return;
    }
    else if (kind < 0.8)
    {
        plan.Faults.push_back(
            {.At = at, .Kind = random.Chance(0.7) ? FaultKind::Crash : FaultKind::Leave, .A = a});
        plan.Faults.push_back({.At = std::min(at + random.LogBetween(1ms, 40s), plan.CalmAt),
                               .Kind = FaultKind::Start,
                               .A = a,
                               .LoseStorage = plan.IncarnationsMayFall && random.Chance(0.5)});
    }
    else if (kind < 0.92)
    {
        // From steps that look like a delay up to more than an hour.
        const std::int64_t seconds = random.LogBetween(1, 5000) * (random.Chance(0.5) ? 1 : -1);
        plan.Faults.push_back({.At = at, .Kind = FaultKind::ClockStep, .A = a, .Amount = seconds});
    }
    else
    {
        plan.Faults.push_back(
            {.At = at, .Kind = FaultKind::Stall, .A = a, .Amount = random.LogBetween(100ms, 60s).count()});
    }
}

}  // namespace

FleetPlan::FleetPlan(std::uint64_t seed)
{
    SimRandom random(seed * 0x2545f4914f6cdd1dULL + 7);
    HasKeys = seed >= FirstKeyedSeed;
    seed >= FirstThinSeed && !HasKeys ? DrawThin(random) : DrawWide(random);
}

// Bad networks with many faults, but with room for all that is sent.
void FleetPlan::DrawWide(SimRandom &random)
{
    IncarnationsMayFall = random.Chance(0.5);
    Lease = random.Chance(0.5) ? GatewayConfig().Lease : std::chrono::milliseconds(3000);
    const double size = random.Unit();
    const std::size_t count = size < 0.5   ? 2
                              : size < 0.8 ? 3
                                           : static_cast<std::size_t>(random.Between(4, 6));
    for (std::size_t i = 0; i < count; ++i)
    {
        Machines.push_back(DrawMachine(random, i, i > 1));
        // Without a file only the wall clock numbers the lives, and the numbers may fall if the clock
        // steps.
        Machines.back().KeepsCounter = Machines.back().KeepsCounter || !IncarnationsMayFall;
    }
    for (std::size_t i = 0; i < count; ++i)
    {
        for (std::size_t j = 0; j < count; ++j)
        {
            Start.push_back(DrawWeather(random));
            Machines[i].Send.push_back(DrawRule(random, Machines[j].Name));
        }
    }
    CalmAt = random.LogBetween(5s, count > 3 ? 40s : 120s);
    const std::int64_t faults = random.Between(0, 4 + static_cast<std::int64_t>(CalmAt / 10s));
    for (std::int64_t i = 0; i < faults; ++i)
    {
        AddFault(*this, random);
    }
    const std::int64_t bursts = random.LogBetween(5, 150);
    for (std::int64_t i = 0; i < bursts; ++i)
    {
        const std::size_t source = random.Index(count);
        const std::size_t destination =
            random.Chance(0.1) ? Burst::ToAll : (source + 1 + random.Index(count - 1)) % count;
        const int burst = random.Chance(0.8) ? 1 : static_cast<int>(random.LogBetween(2, 100));
        Bursts.push_back({random.Between(0ms, CalmAt + 1s), source, destination, burst});
    }
    const std::int64_t modes = random.Between(0, 20);
    for (std::int64_t i = 0; i < modes; ++i)
    {
        Modes.push_back({random.Between(0ms, CalmAt), random.Index(count)});
    }
}

}  // namespace Rabit::Sim
