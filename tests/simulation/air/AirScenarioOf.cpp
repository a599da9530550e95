#include <algorithm>
#include <array>
#include <sstream>

#include "AirSimulation.h"
#include "SimRandom.h"

namespace Rabit::Sim
{
namespace
{

using namespace std::chrono_literals;

bool Falls(const AirScenario &scenario)
{
    return scenario.FallsAt != Time::max();
}

Time LongestWait(const AirResult &result, std::size_t from, std::size_t to)
{
    Time longest{0};
    for (std::size_t i = from; i < to; ++i)
    {
        longest = std::max(longest, result.Seconds.at(i).LongestWait);
    }
    return longest;
}

std::string Milliseconds(Time time)
{
    return std::to_string(time / 1ms) + " ms";
}

std::string JudgeFall(const AirScenario &scenario, const AirResult &result)
{
    const auto falls = static_cast<std::size_t>(scenario.FallsAt / 1s);
    const auto returns = static_cast<std::size_t>(scenario.ReturnsAt / 1s);
    std::uint64_t packets = 0;
    std::uint64_t late = 0;
    for (std::size_t i = falls + 5; i < returns; ++i)
    {
        packets += result.Seconds.at(i).Packets;
        late += result.Seconds.at(i).Late;
    }
    if (late * 20 > packets)
    {
        return "the radio fell to a tenth, and from 5 s later on " + std::to_string(late) + " of " +
               std::to_string(packets) + " packets wait for 300 ms and longer";
    }
    if (const Time wait = LongestWait(result, falls + 8, returns); wait >= 600ms)
    {
        return "the radio fell to a tenth, and 8 s later a packet waits for " + Milliseconds(wait);
    }
    for (std::size_t i = returns + 15; i + 1 < result.Seconds.size(); ++i)
    {
        if (result.Seconds[i].Use < 0.8)
        {
            return "the radio returned, and after " + std::to_string(i - returns) + " s " +
                   std::to_string(result.Seconds[i].Use) + " of it is used";
        }
    }
    return "";
}

std::string JudgeBudget(const AirScenario &scenario, const AirResult &result)
{
    if (static_cast<double>(result.MostInASecond) > *scenario.Budget * 1.05)
    {
        return "a node sent " + std::to_string(result.MostInASecond) + " bytes in a second";
    }
    const double seconds = std::chrono::duration<double>(scenario.Ends - scenario.Settled).count();
    const auto least = *std::min_element(result.BytesOf.begin(), result.BytesOf.end());
    if (static_cast<double>(least) < 0.75 * *scenario.Budget * seconds)
    {
        return "a node used " + std::to_string(static_cast<double>(least) / seconds) + " B/s of its budget";
    }
    AirScenario idle = scenario;
    idle.Offered = 0.0;
    const Time quiet = AirResult::Quantile(RunAir(idle).CommandWaits, 0.99);
    const Time busy = AirResult::Quantile(result.CommandWaits, 0.99);
    // A command waits for the datagram that was begun, and for an acknowledgement, which is of the same
    // class.
    const double bytes = std::clamp(*scenario.Budget / 4.0, 400.0, 1428.0) +
                         (scenario.Acknowledged ? static_cast<double>(scenario.ReportBytes()) : 0.0);
    const Time before(static_cast<Time::rep>(bytes * 1e9 / *scenario.Budget));
    if (busy > 2 * (quiet + before))
    {
        return "commands wait for " + Milliseconds(busy) + ", and idle for " + Milliseconds(quiet);
    }
    return "";
}

std::string JudgeSteady(const AirScenario &scenario, const AirResult &result)
{
    if (result.Use < 0.8)
    {
        return std::to_string(result.Use) + " of the radio is used";
    }
    const Time wait = AirResult::Quantile(result.Waits, 0.95);
    if (wait >= 300ms)
    {
        return "one packet in twenty waits for " + Milliseconds(wait);
    }
    // A node that acknowledges sends small packets, and a radio gives turns, not bytes.
    const auto end = result.BytesOf.end() - (scenario.Acknowledged ? 1 : 0);
    const auto [least, most] = std::minmax_element(result.BytesOf.begin(), end);
    if (*most > 2 * *least)
    {
        return "one node sent " + std::to_string(*most) + " bytes and another " + std::to_string(*least);
    }
    return "";
}

std::string JudgeDeaf(const AirScenario &scenario, const AirResult &result)
{
    if (result.RateWhenDeaf && (!result.RateAtEnd || *result.RateAtEnd > 1.1 * *result.RateWhenDeaf))
    {
        return "a node that hears nothing any more sends more than before";
    }
    if (result.RateWhenDeaf && *result.RateAtEnd < 0.4 * *result.RateWhenDeaf)
    {
        return "a node that hears nothing any more falls silent";
    }
    const auto others = *std::min_element(result.BytesOf.begin() + 1, result.BytesOf.end());
    const double share =
        static_cast<double>(others) * 8.0 * static_cast<double>(scenario.Nodes) /
        (scenario.BitsPerSecond * std::chrono::duration<double>(scenario.Ends - scenario.Settled).count());
    // The deaf node's packets are longer, and a radio gives turns, not bytes.
    return share < 0.33 ? "one node hears nothing, and another has " + std::to_string(share) + " of its share"
                        : "";
}

}  // namespace

AirScenario ScenarioOf(std::uint64_t seed)
{
    SimRandom random(seed);
    AirScenario scenario;
    scenario.Seed = seed;
    scenario.Nodes = static_cast<std::size_t>(random.Between(2, 6));
    scenario.BitsPerSecond = std::array{57.6e3, 250e3, 1e6}[random.Index(3)];
    scenario.Loss = random.Chance(0.5) ? 0.2 : 0.0;
    scenario.Acknowledged = random.Chance(0.5);
    scenario.Settled = scenario.BitsPerSecond < 100e3 ? 60s : 30s;
    scenario.Ends = scenario.Settled + 60s;
    switch (random.Between(0, 5))
    {
        case 0:
            scenario.Nodes = 3;
            scenario.Senders = static_cast<std::size_t>(random.Between(1, 2));
            scenario.Acknowledged = true;
            scenario.BitsPerSecond = 1e6;
            scenario.FallsTo = 100e3;
            scenario.FallsAt = 40s;
            scenario.ReturnsAt = 80s;
            scenario.Ends = 120s;
            break;
        case 1:
            scenario.Budget = static_cast<double>(random.LogBetween(1500, 8000));
            scenario.BitsPerSecond = 1e6;
            scenario.Settled = 5s;
            scenario.Ends = 95s;
            scenario.Commands = 1500ms;
            break;
        case 2:
            scenario.DeafAt = scenario.Settled;
            break;
        default:
            break;
    }
    return scenario;
}

std::string Judge(const AirScenario &scenario, const AirResult &result)
{
    return Falls(scenario)                  ? JudgeFall(scenario, result)
           : scenario.Budget                ? JudgeBudget(scenario, result)
           : scenario.DeafAt != Time::max() ? JudgeDeaf(scenario, result)
                                            : JudgeSteady(scenario, result);
}

}  // namespace Rabit::Sim
