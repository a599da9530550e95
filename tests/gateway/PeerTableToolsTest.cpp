// How the table of peers treats tools.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "presence/PeerTable.h"
#include "wire/BeatExtensions.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Gateway::NodeState;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Ns = std::chrono::nanoseconds;

class PeerTableToolsTest : public ::testing::Test
{
protected:
    static HeardBeat BeatOf(const std::string &node, std::uint64_t incarnation, Ns at)
    {
        HeardBeat heard;
        heard.Node = node;
        heard.Incarnation = incarnation;
        heard.Utc = (at + 1'700'000'000s).count();
        heard.Beat.source_ns = (at + 1000s).count();
        heard.Beat.next_ms = 2000;
        heard.Beat.offers = 77;
        heard.Arrival = at;
        return heard;
    }

    PeerTable::Change HearTool(const std::string &node, Ns at, std::uint64_t incarnation = 5)
    {
        HeardBeat heard = BeatOf(node, incarnation, at);
        BeatExtensions::MarkTool(heard.Beat);
        return table.OnBeat(heard);
    }

    PeerTable::Change HearNode(const std::string &node, Ns at, std::uint64_t incarnation = 5)
    {
        return table.OnBeat(BeatOf(node, incarnation, at));
    }

    PeerTable::Change HearSum(const std::string &node, std::uint32_t sum, Ns at)
    {
        HeardBeat heard = BeatOf(node, 5, at);
        BeatExtensions::SayFleetSum(heard.Beat, sum);
        return table.OnBeat(heard);
    }

    PeerTable table{"ground", 7};
};

TEST_F(PeerTableToolsTest, AToolIsNotAmongTheNodesThatWereHeard)
{
    HearNode("uav1", 1s);
    const PeerTable::Change change = HearTool("tool", 1s);
    EXPECT_TRUE(change.Beat);
    EXPECT_FALSE(change.State || change.NewLife || change.Offers);
    ASSERT_THAT(table.Heard(), SizeIs(1));
    EXPECT_EQ(table.Heard().front()->Node, "uav1");
}

TEST_F(PeerTableToolsTest, AToolsAnnouncementIsNotAskedFor)
{
    HearTool("tool", 1s);
    EXPECT_TRUE(table.Missing().IsEmpty());
    HearNode("uav1", 1s);
    EXPECT_FALSE(table.Missing().IsEmpty());
}

TEST_F(PeerTableToolsTest, AToolsBeatsGoBackToItSoThatItMayMeasureTheRoundTrip)
{
    HearTool("tool", 1s);
    ASSERT_EQ(table.EchoesDue(1s, 8), 1u);
    EXPECT_EQ(table.NextEchoes(1s, 8, 8).front().node, table.Find("tool")->Tag);
}

// It may not hear the first of them yet.
TEST_F(PeerTableToolsTest, AToolIsEchoedThreeTimesAtFirst)
{
    HearTool("tool", 1s);
    for (int i = 0; i < 3; ++i)
    {
        EXPECT_EQ(table.NextEchoes(1s, 8, 8).size(), 1u);
    }
    EXPECT_EQ(table.EchoesDue(1s, 8), 0u);
}

TEST_F(PeerTableToolsTest, AToolThatLeavesIsForgottenAtOnce)
{
    HearTool("tool", 1s);
    const PeerTable::Change change = table.OnLeft("tool", 5);
    EXPECT_THAT(change.Forgotten, ElementsAre("tool"));
    EXPECT_FALSE(change.State);
    EXPECT_EQ(table.Find("tool"), nullptr);
    EXPECT_EQ(table.Forgotten(), 0u);
}

TEST_F(PeerTableToolsTest, AGoodbyeForgetsAToolToo)
{
    HearTool("tool", 1s);
    HeardBeat goodbye = BeatOf("tool", 5, 2s);
    goodbye.Beat.leaving = true;
    EXPECT_THAT(table.OnBeat(goodbye).Forgotten, ElementsAre("tool"));
}

TEST_F(PeerTableToolsTest, AToolThatFallsSilentIsForgottenAfterSevenOfItsBeatsAndIsNeverStale)
{
    HearTool("tool", 1s);
    EXPECT_FALSE(table.Advance(15s).Any());
    EXPECT_EQ(table.Find("tool")->State, NodeState::UP);
    EXPECT_EQ(table.NextChange(), 15s + 1ns);
    const PeerTable::Change change = table.Advance(15s + 1ns);
    EXPECT_FALSE(change.State);
    EXPECT_THAT(change.Forgotten, ElementsAre("tool"));
    EXPECT_EQ(table.Tools(), 0u);
}

TEST_F(PeerTableToolsTest, ToolsTakeNoPlaceOfANode)
{
    for (std::size_t i = 0; i < PeerTable::MaximumPeers; ++i)
    {
        HearNode(std::string("node").append(std::to_string(i)), 1s + Ns(i));
    }
    HearTool("tool", 2s);
    EXPECT_NE(table.Find("tool"), nullptr);
    EXPECT_THAT(table.Heard(), SizeIs(PeerTable::MaximumPeers));
    EXPECT_EQ(table.CrowdedOut() + table.Forgotten(), 0u);
}

TEST_F(PeerTableToolsTest, NoMoreToolsAreKeptThanThereIsRoomFor)
{
    for (std::size_t i = 0; i < 2 * PeerTable::MostTools; ++i)
    {
        HearTool(std::string("tool").append(std::to_string(i)), 1s);
    }
    EXPECT_EQ(table.Tools(), PeerTable::MostTools);
    table.OnLeft("tool0", 5);
    EXPECT_TRUE(HearTool("late", 2s).Beat);
}

TEST_F(PeerTableToolsTest, AToolThatBeginsAgainIsOneToolStill)
{
    HearTool("tool", 1s, 5);
    EXPECT_TRUE(HearTool("tool", 2s, 6).Beat);
    EXPECT_EQ(table.Tools(), 1u);
    EXPECT_EQ(table.Find("tool")->Incarnation, 6u);
    EXPECT_FALSE(HearTool("tool", 3s, 5).Beat) << "a straggler of the earlier life";
}

TEST_F(PeerTableToolsTest, AToolUnderALiveNodesNameIsASecondNodeOfThatName)
{
    HearNode("uav1", 1s, 5);
    for (const Ns at : {1s, 2s, 3s})
    {
        HearTool("uav1", at, 9);
        HearNode("uav1", at, 5);
    }
    EXPECT_TRUE(table.Find("uav1")->Twice);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 5u);
    EXPECT_EQ(table.Tools(), 0u);
}

TEST_F(PeerTableToolsTest, AToolUnderALostNodesNameChangesNothingOfTheNode)
{
    HearNode("uav1", 1s, 5);
    table.Advance(60s);
    for (const Ns at : {60s, 61s, 62s, 63s})
    {
        EXPECT_FALSE(HearTool("uav1", at, 9).Any());
    }
    EXPECT_EQ(table.Find("uav1")->State, NodeState::LOST);
    EXPECT_FALSE(table.Find("uav1")->Twice);
}

TEST_F(PeerTableToolsTest, ANodeUnderTheNameOfAToolTakesItsPlace)
{
    HearTool("uav1", 1s, 5);
    const PeerTable::Change change = HearNode("uav1", 2s, 4);
    EXPECT_TRUE(change.NewLife);
    EXPECT_EQ(table.Tools(), 0u);
    ASSERT_THAT(table.Heard(), SizeIs(1));
    EXPECT_EQ(table.Heard().front()->State, NodeState::UP);
}

TEST_F(PeerTableToolsTest, OnlyTheAnnouncementsThatAreWantedAreAskedFor)
{
    table.BeTool([](const std::string &node) { return node == "uav2"; });
    HearNode("uav1", 1s);
    EXPECT_TRUE(table.Missing().IsEmpty());
    HearNode("uav2", 1s);
    EXPECT_FALSE(table.Missing().IsEmpty());
}

TEST_F(PeerTableToolsTest, ANodeHasNothingToPostWhenAnotherOneTellsANewSumOfTheFleet)
{
    HearNode("uav1", 1s);
    EXPECT_FALSE(HearSum("uav1", 77, 2s).State);
    EXPECT_EQ(table.Find("uav1")->FleetSum, 77u);
}

TEST_F(PeerTableToolsTest, AToolPostsANewSumOfTheFleet)
{
    table.BeTool({});
    HearNode("uav1", 1s);
    EXPECT_TRUE(HearSum("uav1", 77, 2s).State);
    EXPECT_FALSE(HearSum("uav1", 77, 3s).State) << "it is not new";
}

}  // namespace
}  // namespace Rabit
