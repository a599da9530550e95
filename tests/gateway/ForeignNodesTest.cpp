// Foreign topics of whole nodes on the simulated network, where all programs are nodes.
#include <gmock/gmock.h>

#include "PlainProgram.h"
#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ForeignNodes, WhatANodeWritesIsNotReadFromItsTopic)
{
    SimulatedFleet fleet;
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    GatewayConfig config;
    config.Node = "lab";
    config.Foreign.push_back({.Topic = "Pose", .Type = "Uav::Pose", .Local = "Lab/Pose"});
    SimulatedNode &lab = fleet.Add(config);
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto read = lab.Register<Uav::Pose>("Lab/Pose");
    fleet.RunFor(3s);
    pose->PostMessage();
    fleet.RunFor(2s);
    EXPECT_FALSE(read->FetchMessage() && read->WasPosted());
    const Gateway::Fleet told = lab.Fleet();
    ASSERT_EQ(told.foreign.size(), 1u);
    EXPECT_EQ(told.foreign[0].of_nodes, 1u);
    EXPECT_EQ(told.foreign[0].samples, 0u);
    EXPECT_EQ(told.foreign[0].state, Gateway::NodeState::LOST);
    EXPECT_THAT(lab.Problems(),
                HasSubstr("foreign Pose: only nodes of Rabit, and no program, write `Pose` in domain 0\n"));
}

TEST(ForeignNodes, AMessageOfAnotherNodeMayBeWrittenToATopic)
{
    SimulatedFleet fleet;
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    GatewayConfig config = GroundConfig();
    config.Foreign.push_back({.Way = ForeignRule::Direction::Publish,
                              .Topic = "/uav1/pose",
                              .Type = "Uav::Pose",
                              .Local = "uav1/Pose",
                              .Names = ForeignRule::WireNames::Ros2});
    SimulatedNode &ground = fleet.Add(config);
    auto pose = uav.Register<Uav::Pose>("Pose");
    fleet.RunFor(3s);
    pose->PostMessage();
    fleet.RunFor(2s);
    const Gateway::Fleet told = ground.Fleet();
    ASSERT_EQ(told.foreign.size(), 1u);
    EXPECT_TRUE(told.foreign[0].written);
    EXPECT_EQ(told.foreign[0].topic, "rt/uav1/pose");
    EXPECT_EQ(told.foreign[0].type, "Uav::dds_::Pose_");
    EXPECT_EQ(told.foreign[0].samples, 1u);
    EXPECT_EQ(told.foreign[0].reason, "no program reads `rt/uav1/pose` in domain 0");
    EXPECT_THAT(ground.Problems(), Not(HasSubstr("foreign")));
}

// Writes the queue `Goals` to the topic `goals`.
GatewayConfig ConfigWithWrittenQueue(const std::string &node)
{
    GatewayConfig config = AircraftConfig(node);
    config.Foreign.push_back({.Way = ForeignRule::Direction::Publish,
                              .Topic = "goals",
                              .Type = "Uav::Goto",
                              .Local = "Goals",
                              .Each = ForeignRule::Delivery::Queue});
    return config;
}

TEST(ForeignNodes, EachMessageOfAQueueReachesAProgram)
{
    SimulatedFleet fleet;
    PlainProgram program(fleet.Network, "goals", "Uav::Goto");
    SimulatedNode &uav = fleet.Add(ConfigWithWrittenQueue("uav1"));
    fleet.RunFor(3s);
    for (std::uint32_t number = 1; number <= 1000; ++number)
    {
        auto message = std::make_shared<Uav::Goto>();
        message->id = number;
        ASSERT_TRUE(uav.Workspace.AddMessageToQueue("Goals", message));
    }
    EXPECT_FALSE(uav.Workspace.AddMessageToQueue("Goals", std::make_shared<Uav::Goto>()));
    fleet.RunFor(2s);
    ASSERT_EQ(program.Samples.size(), 1000u);
    for (std::uint32_t number = 1; number <= 1000; ++number)
    {
        Uav::Goto goal;
        ASSERT_TRUE(Uav::Goto::IdlType().Deserialize(program.Samples[number - 1], goal));
        ASSERT_EQ(goal.id, number);
    }
    const Gateway::ForeignTopic told = uav.Fleet().foreign.at(0);
    EXPECT_EQ(told.local, "Goals");
    EXPECT_EQ(told.samples, 1000u);
    EXPECT_EQ(told.refused, 1u);
    EXPECT_EQ(told.readers, 1u);
}

TEST(ForeignNodes, AQueueForATopicMayHaveASlashInItsName)
{
    SimulatedFleet fleet;
    PlainProgram program(fleet.Network, "goals", "Uav::Goto");
    GatewayConfig config = ConfigWithWrittenQueue("uav1");
    config.Foreign[0].Local = "Px4/Goals";
    SimulatedNode &uav = fleet.Add(config);
    fleet.RunFor(3s);
    EXPECT_TRUE(uav.Workspace.AddMessageToQueue("Px4/Goals", std::make_shared<Uav::Goto>()));
    fleet.RunFor(1s);
    EXPECT_EQ(program.Samples.size(), 1u);
}

}  // namespace
}  // namespace Rabit
