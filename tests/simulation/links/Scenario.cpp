#include "Scenario.h"

#include <algorithm>
#include <iterator>

namespace Rabit::Sim
{

namespace
{

using namespace std::chrono_literals;

Weather DrawWeather(SimRandom &random)
{
    Weather weather;
    weather.Loss = random.Chance(0.4) ? 0 : random.Chance(0.7) ? random.Unit() * 0.2 : random.Unit() * 0.6;
    weather.Duplicate = random.Chance(0.5) ? 0 : random.Unit() * 0.2;
    weather.Straggle = random.Chance(0.6) ? 0 : random.Unit() * 0.03;
    weather.Delay = random.LogBetween(100us, 400ms);
    weather.Jitter = random.Chance(0.3) ? 0ms : LinkTime(random.Between(0, 2 * weather.Delay.count()));
    return weather;
}

std::int64_t DrawRate(SimRandom &random)
{
    static constexpr std::int64_t Rates[] = {57'600, 100'000, 250'000, 1'000'000};
    return Rates[random.Index(std::size(Rates))];
}

ScenarioNode DrawNode(SimRandom &random, std::size_t index, bool mayBeAbsent, bool clockAlone)
{
    ScenarioNode node;
    node.Name.assign(1, 'n');
    node.Name += std::to_string(index);
    node.Incarnations = clockAlone && random.Chance(0.3) ? IncarnationMode::WallClock
                        : random.Chance(0.6)             ? IncarnationMode::Counter
                                                         : IncarnationMode::CounterAndClock;
    node.NeverThere = mayBeAbsent && random.Chance(0.15);
    node.DriftPpm = random.Chance(0.5) ? 0 : random.Between(-500, 500);
    node.DriverDelay = random.Chance(0.6) ? 0ms : random.LogBetween(10us, 20ms);
    node.RoomIsWrong = random.Chance(0.05);
    return node;
}

ScenarioQueue DrawQueue(SimRandom &random, std::size_t index)
{
    ScenarioQueue queue;
    queue.Name.assign(1, 'q');
    queue.Name += std::to_string(index);
    queue.Capacity = static_cast<std::size_t>(random.LogBetween(1, 300));
    queue.ConsumePeriod = random.Chance(0.6) ? random.LogBetween(100us, 20ms) : random.LogBetween(20ms, 2s);
    queue.PopEventLoss = random.Chance(0.8) ? 0 : random.Unit() * 0.5;
    queue.LocalFill = random.Chance(0.8) ? 0 : random.Unit() * 0.7;
    return queue;
}

LinkOptions DrawOptions(SimRandom &random)
{
    LinkOptions options;
    options.Capacity = static_cast<std::size_t>(random.LogBetween(1, 300));
    options.CapacityBytes =
        random.Chance(0.7) ? 1000000 : static_cast<std::size_t>(random.Between(100, 5000));
    options.Expire = random.Chance(0.5) ? 0ms : random.LogBetween(20ms, 60s);
    options.Window = static_cast<std::size_t>(random.LogBetween(1, 256));
    options.RedeliverInDoubt = random.Chance(0.3);
    return options;
}

void AddCut(Scenario &scenario, std::size_t a, std::size_t b, LinkTime from, LinkTime to)
{
    scenario.Faults.push_back({.At = from, .Kind = FaultKind::CutStart, .A = a, .B = b});
    scenario.Faults.push_back({.At = to, .Kind = FaultKind::CutEnd, .A = a, .B = b});
}

void AddFault(Scenario &scenario, SimRandom &random)
{
    const std::size_t count = scenario.Nodes.size();
    const std::size_t a = random.Index(count);
    const std::size_t b =
        (a + static_cast<std::size_t>(random.Between(1, static_cast<std::int64_t>(count) - 1))) % count;
    const LinkTime at = random.Between(0ms, scenario.CalmAt);
    const double kind = random.Unit();
    if (kind < 0.25)
    {
        scenario.Faults.push_back(
            {.At = at, .Kind = FaultKind::Weather, .A = a, .B = b, .Weather = DrawWeather(random)});
    }
    else if (kind < 0.5)
    {
        const LinkTime end = std::min(at + random.LogBetween(1s, 120s), scenario.CalmAt);
        AddCut(scenario, a, b, at, end);
        if (random.Chance(0.6))
        {
            AddCut(scenario, b, a, at, end);
        }
    }
    else if (kind < 0.79)
    {
        if (scenario.Nodes[a].NeverThere)
        {
            return;
        }
        const LinkTime start = std::min(at + random.LogBetween(1ms, 40s), scenario.CalmAt);
        scenario.Faults.push_back({.At = at, .Kind = FaultKind::Crash, .A = a});
        scenario.Faults.push_back({.At = start,
                                   .Kind = FaultKind::Start,
                                   .A = a,
                                   .LoseStorage = scenario.IncarnationsMayFall && random.Chance(0.5)});
    }
    else if (kind < 0.88)
    {
        scenario.Faults.push_back({.At = at, .Kind = FaultKind::Forget, .A = a, .B = b});
    }
    else if (kind < 0.93)
    {
        const std::int64_t seconds = random.LogBetween(1, 1000000) * (random.Chance(0.5) ? 1 : -1);
        scenario.Faults.push_back({.At = at, .Kind = FaultKind::ClockStep, .A = a, .Amount = seconds});
    }
    else
    {
        scenario.Faults.push_back(
            {.At = at, .Kind = FaultKind::Stall, .A = a, .Amount = random.LogBetween(100ms, 60s).count()});
    }
}

}  // namespace

Scenario::Scenario(std::uint64_t seed)
{
    SimRandom random(seed * 0x2545f4914f6cdd1dULL + 1);
    IncarnationsMayFall = random.Chance(0.5);
    const double size = random.Unit();
    const std::size_t nodeCount = size < 0.6    ? 2
                                  : size < 0.85 ? 3
                                                : static_cast<std::size_t>(random.Between(4, 6));
    for (std::size_t i = 0; i < nodeCount; ++i)
    {
        Nodes.push_back(DrawNode(random, i, nodeCount > 2 && i > 1, IncarnationsMayFall));
    }
    const std::size_t queueCount = random.Chance(0.7) ? 1 : 2;
    for (std::size_t i = 0; i < queueCount; ++i)
    {
        Queues.push_back(DrawQueue(random, i));
    }
    for (std::size_t i = 0; i < nodeCount; ++i)
    {
        for (std::size_t j = 0; j < nodeCount; ++j)
        {
            Start.push_back(DrawWeather(random));
            for (std::size_t q = 0; i != j && q < queueCount; ++q)
            {
                if ((i == 0 && j == 1) || random.Chance(0.5))
                {
                    Links.push_back({i, j, q, DrawOptions(random)});
                }
            }
        }
    }
    CalmAt = nodeCount > 3 ? random.LogBetween(5s, 60s) : random.LogBetween(5s, 200s);
    WaitForStragglers = random.Chance(0.3);
    MalformedPart = random.Chance(0.8) ? 0 : 0.01;

    const std::int64_t faults = random.Between(0, 4 + static_cast<std::int64_t>(CalmAt / 10s));
    for (std::int64_t i = 0; i < faults; ++i)
    {
        AddFault(*this, random);
    }
    const std::int64_t bursts = random.LogBetween(5, 150);
    for (std::int64_t i = 0; i < bursts; ++i)
    {
        const auto link = random.Index(Links.size());
        const int count = random.Chance(0.8) ? 1 : static_cast<int>(random.LogBetween(2, 100));
        Bursts.push_back({random.Between(0ms, CalmAt + 1s), link, count});
    }

    if (random.Chance(0.5))
    {
        Medium.BitsPerSecond = DrawRate(random);
        Medium.QueueBytes = static_cast<std::size_t>(random.LogBetween(6'000, 64'000));
        for (std::int64_t changes = random.Between(0, 3); changes > 0; --changes)
        {
            Faults.push_back(
                {.At = random.Between(0ms, CalmAt), .Kind = FaultKind::Rate, .Amount = DrawRate(random)});
        }
    }

    Settings.MaxDatagram = static_cast<std::size_t>(random.LogBetween(200, 5000));
    Settings.AckDelay = random.Chance(0.7) ? LinkTime(2ms) : random.LogBetween(1us, 20ms);
    Settings.AckEvery = static_cast<std::size_t>(random.LogBetween(1, 64));
}

}  // namespace Rabit::Sim
