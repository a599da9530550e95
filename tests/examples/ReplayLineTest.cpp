#include "ReplayLine.h"

#include <gtest/gtest.h>

namespace
{
using Rabit::Gateway::NodeState;

Rabit::Gateway::NodeStatus Node(const std::string &name, bool replay, NodeState state = NodeState::UP)
{
    Rabit::Gateway::NodeStatus status;
    status.node = name;
    status.replay = replay;
    status.state = state;
    return status;
}

TEST(ReplayLine, IsEmptyWhileAllIsLive)
{
    Rabit::Gateway::Fleet fleet;
    EXPECT_EQ(Ground::ReplayLine(fleet), "");
    fleet.nodes = {Node("uav1", false)};
    EXPECT_EQ(Ground::ReplayLine(fleet), "");
}

TEST(ReplayLine, NamesThoseThatPlayARecordingAndAreThere)
{
    Rabit::Gateway::Fleet fleet;
    fleet.nodes = {Node("uav1", false), Node("replay.uav1", true),
                   Node("replay.uav2", true, NodeState::STALE), Node("replay.uav3", true, NodeState::LOST)};
    EXPECT_EQ(Ground::ReplayLine(fleet), "REPLAY of a recording, not live: replay.uav1, replay.uav2");
}

TEST(ReplayLine, NamesNoMoreThanFitAndWhatCanBePrinted)
{
    Rabit::Gateway::Fleet fleet;
    for (int i = 1; i <= 8; ++i)
        fleet.nodes.push_back(Node("r\x1b" + std::to_string(i), true));
    EXPECT_EQ(Ground::ReplayLine(fleet),
              "REPLAY of a recording, not live: r?1, r?2, r?3, r?4, r?5, r?6 and 2 more");
}

}  // namespace
