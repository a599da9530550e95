#include <gtest/gtest.h>

#include "AirSimulation.h"

namespace Rabit::Sim
{
namespace
{

using namespace std::chrono_literals;

// Expects that the scenario holds over some seeds.
void HoldsFor(AirScenario scenario, int seeds)
{
    for (int seed = 1; seed <= seeds; ++seed)
    {
        scenario.Seed = static_cast<std::uint64_t>(seed);
        EXPECT_EQ(Judge(scenario, RunAir(scenario)), "") << "seed " << seed;
    }
}

TEST(AirCases, AThinRadioIsSharedWithShortQueues)
{
    HoldsFor({.Nodes = 4, .BitsPerSecond = 57.6e3, .Acknowledged = false, .Settled = 60s, .Ends = 120s}, 8);
}

TEST(AirCases, ARadioIsSharedFairlyByManyWithShortQueues)
{
    HoldsFor({.Nodes = 6, .BitsPerSecond = 250e3, .Acknowledged = false}, 8);
}

// Not each beat has room for each node.
TEST(AirCases, ARadioIsSharedByMoreNodesThanABeatReportsOn)
{
    HoldsFor({.Nodes = 12,
              .BitsPerSecond = 1e6,
              .Acknowledged = false,
              .ReportsTakeTurns = true,
              .Settled = 60s,
              .Ends = 120s},
             8);
}

TEST(AirCases, AWideRadioIsUsed)
{
    HoldsFor({.Nodes = 2, .BitsPerSecond = 1e6, .Acknowledged = false}, 4);
}

TEST(AirCases, AFifthOfThePacketsMayBeLost)
{
    HoldsFor({.Nodes = 5, .BitsPerSecond = 250e3, .Loss = 0.2}, 8);
}

TEST(AirCases, ARadioMayFallToATenthAndReturn)
{
    HoldsFor({.Nodes = 3,
              .BitsPerSecond = 1e6,
              .FallsTo = 100e3,
              .FallsAt = 40s,
              .ReturnsAt = 80s,
              .Senders = 2,
              .Ends = 120s},
             4);
}

TEST(AirCases, ANodeThatHearsNothingStaysAsItWas)
{
    HoldsFor({.Nodes = 4, .BitsPerSecond = 250e3, .DeafAt = 30s}, 4);
}

TEST(AirCases, TheFirstSeedsHold)
{
    for (std::uint64_t seed = 1; seed <= 60; ++seed)
    {
        const AirScenario scenario = ScenarioOf(seed);
        EXPECT_EQ(Judge(scenario, RunAir(scenario)), "") << "seed " << seed;
    }
}

TEST(AirCases, ABudgetHoldsInEverySecondAndCommandsComeThrough)
{
    HoldsFor(
        {.Nodes = 4, .BitsPerSecond = 1e6, .Budget = 1500.0, .Commands = 1500ms, .Settled = 5s, .Ends = 95s},
        4);
    HoldsFor(
        {.Nodes = 4, .BitsPerSecond = 1e6, .Budget = 5000.0, .Commands = 1500ms, .Settled = 5s, .Ends = 95s},
        4);
}

}  // namespace
}  // namespace Rabit::Sim
