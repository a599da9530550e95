// Plans over a thin medium that has room for the fleet's traffic.
#include <algorithm>

#include "FleetPlan.h"

namespace Rabit::Sim
{

namespace
{

using namespace std::chrono_literals;

// Mean bytes of a note with its acknowledgement, without the large notes.
constexpr double NoteOnAir = 400;
// Longest time for which a large note takes a node's whole share of the medium.
constexpr std::int64_t LargeNoteSeconds = 4;

// A kind of radio: its rate, and the promises that hold with this many nodes on it.
struct Radio
{
    std::uint64_t BytesPerSecond;
    std::int64_t MostNodes;
    Time UpWithin;
    Time PoseAge;
    Time SlowPoseAge;
};
constexpr Radio Radios[] = {{125'000, 6, 10s, 500ms, 1s}, {31'250, 5, 20s, 1s, 3s}, {7'200, 3, 60s, 3s, 3s}};
constexpr std::uint64_t SmallBudget = 1'500;

SimulatedFaults DrawThinWeather(SimRandom &random)
{
    SimulatedFaults weather;
    weather.Loss = random.Chance(0.5) ? 0 : random.Unit() * 0.05;
    weather.Duplicate = random.Chance(0.7) ? 0 : random.Unit() * 0.02;
    weather.Delay = random.LogBetween(100us, 30ms);
    weather.Jitter = random.Chance(0.5) ? 0ms : Time(random.Between(0, weather.Delay.count()));
    return weather;
}

MachinePlan DrawThinMachine(SimRandom &random, std::size_t index, Time quickestTrack)
{
    MachinePlan machine;
    machine.Name.assign(1, 'n');
    machine.Name += std::to_string(index);
    machine.KeepsCounter = true;
    machine.DriftPpm = random.Between(-100, 100);
    machine.QueueCapacity = static_cast<int>(random.Between(50, 300));
    machine.ConsumePeriod = random.LogBetween(1ms, 20ms);
    machine.TrackPeriod = random.LogBetween(quickestTrack, 4 * quickestTrack);
    return machine;
}

SendRule DrawThinRule(SimRandom &random, const std::string &destination)
{
    SendRule rule;
    rule.To = destination;
    rule.Queue = "Notes";
    rule.Capacity = static_cast<std::size_t>(random.Between(50, 300));
    rule.Expire = random.Chance(0.5)
                      ? 0ms
                      : std::chrono::duration_cast<std::chrono::milliseconds>(random.LogBetween(5s, 60s));
    rule.Window = static_cast<std::size_t>(random.LogBetween(16, 256));
    rule.RedeliverInDoubt = random.Chance(0.3);
    return rule;
}

}  // namespace

void FleetPlan::DrawThin(SimRandom &random)
{
    const Radio &radio = Radios[random.Index(std::size(Radios))];
    Thin = ThinPlan{radio.BytesPerSecond, {}, radio.UpWithin, radio.PoseAge, radio.SlowPoseAge};
    Lease = GatewayConfig().Lease;
    const auto count = static_cast<std::size_t>(random.Between(2, radio.MostNodes));
    if (radio.BytesPerSecond < 10'000)
    {
        Thin->Budget = SmallBudget;
    }
    else if (random.Chance(0.3))
    {
        Thin->Budget = radio.BytesPerSecond / (2 * count);
    }
    const std::uint64_t share = Thin->Budget.value_or(radio.BytesPerSecond / count) / 4;
    const Time quickest = std::max<Time>(100ms, Time(1s) * TrackOnAir / share);
    for (std::size_t i = 0; i < count; ++i)
    {
        Machines.push_back(DrawThinMachine(random, i, quickest));
    }
    for (std::size_t i = 0; i < count; ++i)
    {
        for (std::size_t j = 0; j < count; ++j)
        {
            Start.push_back(DrawThinWeather(random));
            Machines[i].Send.push_back(DrawThinRule(random, Machines[j].Name));
        }
    }
    // The faults come one after the other, with time in between for the nodes to meet again.
    Time at = radio.UpWithin + random.Between(1s, 20s);
    if (random.Chance(0.4))
    {
        const std::int64_t part = random.Between(2, radio.BytesPerSecond < 10'000 ? 3 : 8);
        Faults.push_back({.At = at,
                          .Kind = FaultKind::Rate,
                          .Amount = static_cast<std::int64_t>(radio.BytesPerSecond) / part});
        at += random.Between(10s, 60s);
        Faults.push_back(
            {.At = at, .Kind = FaultKind::Rate, .Amount = static_cast<std::int64_t>(radio.BytesPerSecond)});
        at += random.Between(5s, 20s);
    }
    if (random.Chance(0.4))
    {
        Faults.push_back({.At = at, .Kind = FaultKind::Outage});
        at += 60s;
        Faults.push_back({.At = at, .Kind = FaultKind::OutageEnd});
        at += radio.UpWithin + random.Between(1s, 10s);
    }
    if (random.Chance(0.4))
    {
        const std::size_t who = random.Index(count);
        Faults.push_back(
            {.At = at, .Kind = random.Chance(0.5) ? FaultKind::Crash : FaultKind::Leave, .A = who});
        at += random.LogBetween(10ms, 20s);
        Faults.push_back({.At = at, .Kind = FaultKind::Start, .A = who});
        at += radio.UpWithin;
    }
    CalmAt = at;
    LargestNote =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(4 * share) * LargeNoteSeconds, 3'000, LargestNote);
    const double onAir = NoteOnAir + LargeNotes * static_cast<double>(LargestNote) / 2;
    const auto notes =
        static_cast<std::int64_t>(static_cast<double>(CalmAt / 1s) * static_cast<double>(share) / onAir);
    std::int64_t sent = 0;
    while (sent < std::min<std::int64_t>(notes, 300))
    {
        const std::size_t source = random.Index(count);
        const bool isToAll = random.Chance(0.1);
        const std::size_t destination =
            isToAll ? Burst::ToAll : (source + 1 + random.Index(count - 1)) % count;
        const int burst = random.Chance(0.9) ? 1 : static_cast<int>(random.Between(2, 8));
        Bursts.push_back({random.Between(0ms, CalmAt), source, destination, burst});
        sent += burst * (isToAll ? static_cast<std::int64_t>(count) - 1 : 1);
    }
    const std::int64_t modes = random.Between(0, 20);
    for (std::int64_t i = 0; i < modes; ++i)
    {
        Modes.push_back({random.Between(0ms, CalmAt), random.Index(count)});
    }
}

}  // namespace Rabit::Sim
