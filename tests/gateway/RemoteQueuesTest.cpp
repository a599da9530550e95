#include "presence/RemoteQueues.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace Rabit
{
namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint64_t GotoDefinition = 21;

class RemoteQueuesTest : public ::testing::Test
{
protected:
    static PeerTable::Peer Live(const std::string &node, std::uint64_t incarnation = 5)
    {
        PeerTable::Peer peer;
        peer.Node = node;
        peer.Incarnation = incarnation;
        peer.State = Gateway::NodeState::UP;
        return peer;
    }

    // A node that accepts Goto, of that definition, in MissionControl.
    static PeerTable::Peer Accepting(const std::string &node, std::uint64_t definition = GotoDefinition)
    {
        Gateway::QueueType type;
        type.type = "Uav::Goto";
        type.definition = definition;
        Gateway::AcceptedQueue queue;
        queue.queue = "MissionControl";
        queue.from = {"*"};
        queue.types.push_back(type);
        PeerTable::Peer peer = Live(node);
        peer.Offers.emplace().accepts.push_back(queue);
        return peer;
    }

    RemoteQueues::Answer Ask(const std::string &node) const
    {
        return remote.Ask(node, "MissionControl", "Uav::Goto", GotoDefinition);
    }

    RemoteQueues::LiveNodes All() const
    {
        return remote.LiveNodesFor("MissionControl", "Uav::Goto", GotoDefinition);
    }

    RemoteQueues remote{"ground"};
};

TEST_F(RemoteQueuesTest, ALiveNodeThatHasNotAnnouncedItselfMayAcceptTheMessage)
{
    remote.Update(Accepting("uav1"));
    remote.Update(Live("uav2"));
    PeerTable::Peer lost = Live("uav3");
    lost.State = Gateway::NodeState::LOST;
    remote.Update(lost);
    EXPECT_THAT(All().Accepting, ElementsAre("uav1"));
    EXPECT_THAT(All().NotAnnounced, ElementsAre("uav2"));
    EXPECT_FALSE(remote.Knows("uav2"));
    EXPECT_EQ(Ask("uav2").What, QueueAcceptance::NotAnnounced);
    EXPECT_EQ(Ask("uav2").Reason, "no announcement of uav2 has arrived yet");
    EXPECT_EQ(Ask("uav4").What, QueueAcceptance::UnknownNode);
}

TEST_F(RemoteQueuesTest, ANodeThatHasAnnouncedItselfIsNotTakenForOneThatHasNot)
{
    remote.Update(Live("uav1"));
    remote.Update(Accepting("uav1"));
    EXPECT_THAT(All().Accepting, ElementsAre("uav1"));
    EXPECT_THAT(All().NotAnnounced, IsEmpty());
    EXPECT_TRUE(remote.Knows("uav1"));
}

TEST_F(RemoteQueuesTest, AnAnnouncementHoldsWhileItsNodeIsAway)
{
    remote.Update(Accepting("uav1"));
    PeerTable::Peer lost = Live("uav1");
    lost.State = Gateway::NodeState::LOST;
    remote.Update(lost);
    EXPECT_EQ(Ask("uav1").What, QueueAcceptance::Accepted);
    EXPECT_THAT(All().Accepting, IsEmpty());
}

TEST_F(RemoteQueuesTest, AnAnnouncementEndsWithItsIncarnation)
{
    remote.Update(Accepting("uav1"));
    remote.Update(Live("uav1", 6));
    EXPECT_EQ(Ask("uav1").What, QueueAcceptance::NotAnnounced);
    EXPECT_THAT(All().NotAnnounced, ElementsAre("uav1"));
    PeerTable::Peer again = Accepting("uav1", GotoDefinition + 1);
    again.Incarnation = 6;
    remote.Update(again);
    EXPECT_EQ(Ask("uav1").What, QueueAcceptance::OtherDefinition);
}

}  // namespace
}  // namespace Rabit
