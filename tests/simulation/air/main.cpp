// Runs nodes with schedules and estimates on a simulated radio, over many seeds. SeedRunner.h says how to
// call it.
#include <SeedRunner.h>

#include "AirSimulation.h"

namespace
{

using namespace Rabit::Sim;

SeedResult Run(std::uint64_t seed, std::ostream *trace)
{
    const AirScenario scenario = ScenarioOf(seed);
    const AirResult result = RunAir(scenario, trace);
    const auto one = [](bool is) { return static_cast<std::uint64_t>(is ? 1 : 0); };
    const auto nanoseconds = [](Time time) { return static_cast<std::uint64_t>(time.count()); };
    const bool falls = scenario.FallsAt != Time::max();
    const bool deaf = scenario.DeafAt != Time::max();
    const bool steady = !falls && !deaf && !scenario.Budget;
    return {Judge(scenario, result),
            {{"packets", result.Packets},
             {"commands", result.CommandWaits.size()},
             {"radios that fell and returned", one(falls)},
             {"fleets with a budget", one(scenario.Budget.has_value())},
             {"fleets of whom one is deaf", one(deaf)},
             {"fleets that are limited by the radio alone", one(steady)},
             {"fleets that lose a fifth", one(scenario.Loss > 0.0)},
             {"longest p95 of a packet's wait, radio alone",
              steady ? nanoseconds(AirResult::Quantile(result.Waits, 0.95)) : 0, Figure::Kind::Largest},
             {"longest p99 of a command, budget",
              scenario.Budget ? nanoseconds(AirResult::Quantile(result.CommandWaits, 0.99)) : 0,
              Figure::Kind::Largest}}};
}

}  // namespace

int main(int argc, char **argv)
{
    return RunSeeds("air_simulation", argc, argv, Run);
}
