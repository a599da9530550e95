// How often Gateway/Fleet is posted.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

class FleetPostTest : public ::testing::Test
{
protected:
    FleetPostTest()
    {
        posts = RabitScopedConnection(
            ground.Workspace.FindGlobalMessage(FleetMessageName)
                ->ConnectSomethingPublished([this] { times.push_back(ground.Clock->Monotonic()); }));
    }

    SimulatedFleet fleet;
    SimulatedNode &ground = fleet.Add(GroundConfig());
    std::vector<Ns> times;
    RabitScopedConnection posts;
};

TEST_F(FleetPostTest, TheFleetIsPostedTenTimesASecondAtMostHoweverManyNodesCome)
{
    fleet.RunFor(3s);
    constexpr int Nodes = 20;
    for (int i = 0; i < Nodes; ++i)
    {
        fleet.Add(AircraftConfig("uav" + std::to_string(i)));
        fleet.RunFor(20ms);
    }
    fleet.RunFor(3s);
    std::vector<Ns> gaps;
    std::adjacent_difference(times.begin(), times.end(), std::back_inserter(gaps));
    EXPECT_GE(*std::min_element(gaps.begin() + 1, gaps.end()), 100ms);
    for (int i = 0; i < Nodes; ++i)
    {
        EXPECT_EQ(ground.StateOf("uav" + std::to_string(i)), "UP");
    }
}

TEST_F(FleetPostTest, ANodeThatLeavesIsLostInTheFleetWithinATenthOfASecond)
{
    fleet.Add(AircraftConfig("uav1"));
    fleet.RunFor(5s);
    ASSERT_EQ(ground.StateOf("uav1"), "UP");
    fleet.Stop("uav1");
    EXPECT_TRUE(fleet.RunUntil([this] { return ground.StateOf("uav1") == "LOST"; }, 110ms));
}

}  // namespace
}  // namespace Rabit
