// Foreign topics of whole nodes on the simulated network, where all programs are nodes.
#include <gmock/gmock.h>

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

}  // namespace
}  // namespace Rabit
