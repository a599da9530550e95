// A node that is a tool, among others: whole nodes on the simulated network.
#include <gmock/gmock.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "HandNode.h"
#include "SimulatedFleet.h"
#include "wire/BeatExtensions.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

GatewayConfig ToolConfig(const std::string &name = "tool")
{
    GatewayConfig config;
    config.Node = name;
    config.Tool.emplace();
    return config;
}

class ToolTest : public ::testing::Test
{
protected:
    ToolTest() : uav(fleet.Add(AircraftConfig("uav1"))), ground(fleet.Add(GroundConfig()))
    {
        mission = &uav.AddIdleManager("MissionControl");
        ground.AddIdleManager("Commands");
        state = uav.Register<Uav::MissionState>("MissionState");
        fleet.RunFor(5s);
    }

    // Both nodes post, so that each has something to send to the other.
    void PostState()
    {
        uav.Workspace.AddPublishSubscribeMessage("Pose", pose);
        state->PostMessage();
        pose->PostMessage();
        fleet.RunFor(5s);
    }

    QueueOutcome Send(SimulatedNode &node, const std::string &address = "uav1/MissionControl")
    {
        const auto receipt = std::make_shared<RabitQueueReceipt>();
        node.Workspace.AddMessageToQueue(address, std::make_shared<Uav::Goto>(), receipt);
        fleet.RunFor(5s);
        return receipt->Outcome();
    }

    SimulatedFleet fleet;
    SimulatedNode &uav;
    SimulatedNode &ground;
    IdleManager *mission = nullptr;
    std::shared_ptr<Uav::MissionState> state;
    std::shared_ptr<Uav::Pose> pose = std::make_shared<Uav::Pose>();
};

TEST_F(ToolTest, SeesTheNodesWithTheirRoundTrips)
{
    SimulatedNode &tool = fleet.Add(ToolConfig());
    fleet.RunFor(5s);
    EXPECT_EQ(tool.StateOf("uav1"), "UP");
    EXPECT_EQ(tool.StateOf("ground"), "UP");
    for (const Gateway::NodeStatus &status : tool.Fleet().nodes)
    {
        EXPECT_GT(status.round_trip_s, 0.0) << status.node;
    }
}

TEST_F(ToolTest, ThatJoinsLaterLearnsFromTheOthersWhichNodeIsMissing)
{
    PostState();
    fleet.Kill("uav1");
    fleet.RunFor(10s);
    EXPECT_THAT(ground.Problems(),
                HasSubstr("node uav1: it is LOST: no beat within its limit of 3.5 s; this node subscribes to "
                          "its `Pose`, `MissionState`"));
    GatewayConfig config = ToolConfig();
    config.ProblemsOf = {"*"};
    SimulatedNode &tool = fleet.Add(config);
    fleet.RunFor(5s);
    EXPECT_EQ(tool.StateOf("uav1"), "") << "it was never heard there";
    const Gateway::Fleet seen = tool.Fleet();
    ASSERT_EQ(seen.nodes.size(), 1u);
    EXPECT_THAT(seen.nodes[0].problem_texts, Contains(HasSubstr("node uav1: it is LOST")));
    fleet.Add(AircraftConfig("uav1"), 1.4e9 + 60).AddIdleManager("MissionControl");
    fleet.RunFor(5s);
    EXPECT_THAT(ground.Problems(), Not(HasSubstr("LOST")));
}

TEST_F(ToolTest, IsNotListedByNodesNorByOtherTools)
{
    fleet.Add(ToolConfig());
    SimulatedNode &other = fleet.Add(ToolConfig("other"));
    fleet.RunFor(5s);
    for (SimulatedNode *node : {&uav, &ground, &other})
    {
        EXPECT_EQ(node->StateOf("tool"), "");
    }
    EXPECT_EQ(uav.StateOf("other"), "");
}

TEST_F(ToolTest, IsNoProblemWhenItLeavesOrFallsSilent)
{
    PostState();
    ASSERT_THAT(ground.Problems(), IsEmpty());
    fleet.Add(ToolConfig());
    fleet.Add(ToolConfig("other"));
    fleet.RunFor(5s);
    EXPECT_THAT(ground.Problems(), IsEmpty());
    fleet.Stop("tool");
    fleet.Kill("other");
    for (int i = 0; i < 60; ++i)
    {
        fleet.RunFor(1s);
        ASSERT_THAT(ground.Problems(), IsEmpty()) << i;
        ASSERT_THAT(uav.Problems(), IsEmpty()) << i;
        ASSERT_EQ(ground.Fleet().nodes.size(), 1u);
    }
}

TEST_F(ToolTest, OfASubscriptionToEverybodyNothingIsMissingThatAToolHasNot)
{
    GatewayConfig watch;
    watch.Node = "watch";
    watch.Subscribe.push_back({.Message = "Health", .Type = "Uav::Health"});
    SimulatedNode &watcher = fleet.Add(watch);
    fleet.Add(ToolConfig());
    fleet.RunFor(5s);
    EXPECT_THAT(watcher.Problems(), HasSubstr("uav1 does not publish"));
    for (const Gateway::Problem &problem : watcher.Fleet().problems)
    {
        EXPECT_NE(problem.node, "tool") << problem.reason;
    }
}

TEST_F(ToolTest, IsSentNothingThatGoesToEverybody)
{
    SimulatedNode &tool = fleet.Add(ToolConfig());
    tool.AddIdleManager("MissionControl");
    fleet.RunFor(5s);
    EXPECT_EQ(Send(ground, "*/MissionControl"), QueueOutcome::Delivered);
    EXPECT_EQ(ground.LinkTo("tool", "MissionControl").accepted, 0u);
    EXPECT_EQ(Send(ground, "tool/MissionControl"), QueueOutcome::Refused);
}

TEST_F(ToolTest, SendsToAQueueThatAcceptsFromEverybody)
{
    SimulatedNode &tool = fleet.Add(ToolConfig());
    fleet.RunFor(5s);
    EXPECT_EQ(Send(tool), QueueOutcome::Delivered);
}

TEST_F(ToolTest, SendsUnderItsOwnNameAndIsRefusedWhereThatIsNotAccepted)
{
    GatewayConfig strict = AircraftConfig("uav2");
    strict.Accept[0].From = {"ground", "pilot.*"};
    SimulatedNode &uav2 = fleet.Add(strict);
    uav2.AddIdleManager("MissionControl");
    SimulatedNode &tool = fleet.Add(ToolConfig());
    SimulatedNode &pilot = fleet.Add(ToolConfig("pilot.anna"));
    fleet.RunFor(5s);
    EXPECT_EQ(Send(tool, "uav2/MissionControl"), QueueOutcome::Refused);
    EXPECT_THAT(tool.Problems(), HasSubstr("accepts no messages of this node, but of `ground`, `pilot.*`"));
    EXPECT_EQ(Send(pilot, "uav2/MissionControl"), QueueOutcome::Delivered);
}

TEST_F(ToolTest, LeavesNoTraceOfWhatItHasSent)
{
    fleet.Add(ToolConfig("before"));
    SimulatedNode &tool = fleet.Add(ToolConfig());
    fleet.RunFor(5s);
    ASSERT_EQ(Send(tool), QueueOutcome::Delivered);
    ASSERT_EQ(uav.Fleet().inbound.size(), 1u);
    fleet.Stop("tool");
    fleet.RunFor(2s);
    EXPECT_THAT(uav.Fleet().inbound, IsEmpty());
    EXPECT_EQ(uav.Fleet().forgotten + uav.Fleet().crowded_out + uav.Fleet().malformed, 0u);
}

TEST_F(ToolTest, ReceivesWhatItSubscribesToTheLastStateToo)
{
    PostState();
    GatewayConfig config = ToolConfig();
    config.Subscribe.push_back({.Message = "MissionState", .Type = "Uav::MissionState"});
    SimulatedNode &tool = fleet.Add(config);
    const auto received = tool.Register<Uav::MissionState>("uav1/MissionState");
    fleet.RunFor(2s);
    EXPECT_TRUE(received->FetchMessage());
    EXPECT_THAT(tool.Problems(), IsEmpty());
}

TEST_F(ToolTest, BeatsOnceInTwoSeconds)
{
    int beats = 0;
    HandNode listener(fleet.Network, "listener", 1,
                      [&beats](SampleBytes, const SampleInfo &info)
                      { beats += info.Node == "tool" ? 1 : 0; });
    fleet.Add(ToolConfig());
    fleet.RunFor(10s);
    beats = 0;
    fleet.RunFor(60s);
    EXPECT_GE(beats, 28);
    EXPECT_LE(beats, 32);
}

TEST_F(ToolTest, WithoutAToolNoBeatTellsTheSumOfTheFleet)
{
    std::size_t beats = 0;
    std::size_t sums = 0;
    const HandNode listener(fleet.Network, "listener", 1,
                            [&](SampleBytes bytes, const SampleInfo &)
                            {
                                Gateway::Beat beat;
                                ASSERT_TRUE(MessageTypeRegistry::Of(beat)->Deserialize(bytes, beat));
                                ++beats;
                                sums += BeatExtensions::FleetSumIn(beat) ? 1 : 0;
                            });
    fleet.Add(AircraftConfig("uav2"));
    fleet.RunFor(3s);
    EXPECT_GT(beats, 0u);
    EXPECT_EQ(sums, 0u);
}

TEST_F(ToolTest, AsksForNoOtherAnnouncementsThanItIsToldTo)
{
    fleet.Add(AircraftConfig("uav2"));
    fleet.RunFor(20s);  // what nodes announce at their start has been said
    GatewayConfig config = ToolConfig();
    config.Tool->AsksOf = {"uav2"};
    SimulatedNode &tool = fleet.Add(config);
    fleet.RunFor(5s);
    EXPECT_EQ(Send(tool, "uav1/MissionControl"), QueueOutcome::Refused);
    EXPECT_THAT(tool.Problems(), HasSubstr("no announcement of uav1 has arrived yet"));
    EXPECT_THAT(tool.Problems(), Not(HasSubstr("uav2")));
}

}  // namespace
}  // namespace Rabit
