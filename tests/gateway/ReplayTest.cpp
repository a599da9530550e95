// A node that replays a recording, among others: whole nodes on the simulated network.
#include <gmock/gmock.h>

#include <algorithm>
#include <memory>
#include <string>

#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

GatewayConfig ReplayConfig(const std::string &name)
{
    GatewayConfig config = AircraftConfig(name);
    config.Replay = true;
    return config;
}

class ReplayTest : public ::testing::Test
{
protected:
    ReplayTest() : ground(fleet.Add(GroundConfig())) { ground.AddIdleManager("Commands"); }

    bool IsShownAsReplay(const std::string &node)
    {
        const auto nodes = ground.Fleet().nodes;
        return std::any_of(nodes.begin(), nodes.end(),
                           [&node](const Gateway::NodeStatus &status)
                           { return status.node == node && status.replay; });
    }

    SimulatedFleet fleet;
    SimulatedNode &ground;
};

TEST_F(ReplayTest, IsShownAsOneByTheOthersAndNobodyElseIs)
{
    fleet.Add(AircraftConfig("uav1"));
    fleet.Add(ReplayConfig("replay.uav2"));
    fleet.RunFor(5s);
    EXPECT_EQ(ground.StateOf("replay.uav2"), "UP");
    EXPECT_TRUE(IsShownAsReplay("replay.uav2"));
    EXPECT_FALSE(IsShownAsReplay("uav1"));
}

TEST_F(ReplayTest, ItsMessagesComeAsThoseOfAnyNodeDoWithTheAgeThatTheyWerePostedWith)
{
    SimulatedNode &replay = fleet.Add(ReplayConfig("uav1"));
    const auto state = replay.Register<Uav::MissionState>("MissionState");
    fleet.RunFor(5s);
    const PostTime now = replay.Clock->Now();
    state->text = "recorded";
    state->PostMessage(PostTime{now.GpsTimeSeconds - 7.0, now.Monotonic - 7s});
    const auto received = ground.Register<Uav::MissionState>("uav1/MissionState");
    fleet.RunFor(1s);
    ASSERT_TRUE(received->FetchMessage());
    EXPECT_EQ(received->text, "recorded");
    EXPECT_NEAR(received->GetAgeSeconds(), 8.0, 0.1);
}

TEST_F(ReplayTest, ANodeThatComesUnderTheNameIsNoneAnyMore)
{
    fleet.Add(ReplayConfig("uav1"));
    fleet.RunFor(5s);
    ASSERT_TRUE(IsShownAsReplay("uav1"));
    fleet.Stop("uav1");
    fleet.Add(AircraftConfig("uav1"));
    fleet.RunFor(5s);
    EXPECT_EQ(ground.StateOf("uav1"), "UP");
    EXPECT_FALSE(IsShownAsReplay("uav1"));
}

}  // namespace
}  // namespace Rabit
