#include "NodeState.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{
using Ground::RowState;
using Ground::StateOf;
using Rabit::Gateway::NodeState;

Rabit::Gateway::Fleet FleetWith(NodeState state)
{
    Rabit::Gateway::Fleet fleet;
    Rabit::Gateway::NodeStatus status;
    status.node = "uav1";
    status.state = state;
    fleet.nodes = {status};
    return fleet;
}

TEST(NodeState, IsWhatTheGatewaySays)
{
    EXPECT_EQ(StateOf(FleetWith(NodeState::UP), 0, "uav1"), RowState::Up);
    EXPECT_EQ(StateOf(FleetWith(NodeState::STALE), 0, "uav1"), RowState::Stale);
    EXPECT_EQ(StateOf(FleetWith(NodeState::LOST), 0, "uav1"), RowState::Lost);
    EXPECT_EQ(StateOf(FleetWith(NodeState::UP), 0, "uav2"), RowState::Waiting);
}

TEST(NodeState, IsNotUpWhenTheGatewayHasFallenSilent)
{
    EXPECT_EQ(StateOf(FleetWith(NodeState::UP), Ground::FleetFreshS, "uav1"), RowState::Up);
    EXPECT_EQ(StateOf(FleetWith(NodeState::UP), Ground::FleetFreshS + 0.01, "uav1"), RowState::Stale);
    EXPECT_EQ(StateOf(FleetWith(NodeState::UP), std::numeric_limits<double>::infinity(), "uav1"),
              RowState::Stale);
    EXPECT_EQ(StateOf(FleetWith(NodeState::LOST), 100, "uav1"), RowState::Lost);
}

}  // namespace
