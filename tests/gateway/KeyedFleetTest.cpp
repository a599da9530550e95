// A fleet with keys: five whole nodes on the simulated network, under simulated time.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

class KeyedFleetTest : public ::testing::Test
{
protected:
    KeyedFleetTest()
    {
        fleet.Network.SetFaults("*", "*", {.Loss = 0.05, .Jitter = 5ms});
        fleet.FlyWithKeys();
        for (const char *uav : {"uav1", "uav2", "uav3", "uav4"})
        {
            Add(uav);
        }
        fleet.Add(GroundConfig());
    }

    void Add(const std::string &uav)
    {
        missions[uav] = &fleet.Add(AircraftConfig(uav)).AddIdleManager("MissionControl");
    }

    bool AreAllUp()
    {
        return std::all_of(members.begin(), members.end(),
                           [this](const std::string &node)
                           {
                               return std::all_of(
                                   members.begin(), members.end(),
                                   [&](const std::string &other)
                                   { return other == node || fleet[node].StateOf(other) == "UP"; });
                           });
    }

    // Sends a Goto to an aircraft. Returns whether it was accepted.
    bool SendGoto(SimulatedNode &from, const std::string &uav)
    {
        return from.Workspace.AddMessageToQueue(uav + "/MissionControl", std::make_shared<Uav::Goto>());
    }

    int WaitingAt(const std::string &uav)
    {
        return missions.at(uav)->GetManagerMessageQueue()->NoMessagesInQueue();
    }

    const std::vector<std::string> members{"uav1", "uav2", "uav3", "uav4", "ground"};
    SimulatedFleet fleet;
    std::map<std::string, IdleManager *> missions;
};

TEST_F(KeyedFleetTest, AllMeetAndACommandIsDelivered)
{
    ASSERT_TRUE(fleet.RunUntil([this] { return AreAllUp(); }, 10s));
    // Until uav3's announcement has come.
    EXPECT_TRUE(fleet.RunUntil([this] { return SendGoto(fleet["ground"], "uav3"); }, 2s));
    EXPECT_TRUE(fleet.RunUntil(
        [this] { return fleet["ground"].LinkTo("uav3", "MissionControl").delivered == 1; }, 5s));
    EXPECT_EQ(WaitingAt("uav3"), 1);
    EXPECT_EQ(WaitingAt("uav1"), 0);
    fleet.RunFor(60s);
    EXPECT_TRUE(AreAllUp());
    for (const std::string &node : members)
    {
        EXPECT_THAT(fleet[node].Problems(), Not(HasSubstr("security")));
    }
}

TEST_F(KeyedFleetTest, AProgramWithoutKeysIsNotHeardAndIsAProblem)
{
    fleet.FlyWithKeys(false);
    GatewayConfig config = GroundConfig();
    config.Node = "stranger";
    SimulatedNode &stranger = fleet.Add(config);
    ASSERT_TRUE(fleet.RunUntil([this] { return AreAllUp(); }, 10s));
    static_cast<void>(SendGoto(stranger, "uav1"));
    // A program that hears nobody sends its announcement alone, every 10 s. Five of them are a problem.
    fleet.RunFor(90s);
    EXPECT_TRUE(AreAllUp());
    EXPECT_EQ(WaitingAt("uav1"), 0);
    for (const std::string &node : members)
    {
        EXPECT_THAT(fleet[node].Problems(), HasSubstr("a program without keys sends there, and is not heard"))
            << node;
        EXPECT_EQ(fleet[node].StateOf("stranger"), "") << node;
        EXPECT_EQ(stranger.StateOf(node), "") << node;
    }
}

TEST_F(KeyedFleetTest, AKilledNodeIsHeardAgainWithTheSameKeys)
{
    ASSERT_TRUE(fleet.RunUntil([this] { return AreAllUp(); }, 10s));
    fleet.Kill("uav2");
    fleet.RunFor(10s);
    EXPECT_EQ(fleet["ground"].StateOf("uav2"), "LOST");
    Add("uav2");
    EXPECT_TRUE(fleet.RunUntil([this] { return AreAllUp(); }, 10s));
    EXPECT_TRUE(SendGoto(fleet["ground"], "uav2"));
    EXPECT_TRUE(fleet.RunUntil([this] { return WaitingAt("uav2") == 1; }, 5s));
}

}  // namespace
}  // namespace Rabit
