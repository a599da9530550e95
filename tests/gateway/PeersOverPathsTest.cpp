// The state of a node that is heard over several paths.
#include "paths/PeersOverPaths.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>

#include "BeatSamples.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

class PeersOverPathsTest : public ::testing::Test
{
protected:
    // A beat of uav1 at second 100, the next one due half a second later.
    static void HearOn(PeerTable &path, std::uint64_t incarnation)
    {
        HeardBeat heard;
        heard.Node = "uav1";
        heard.Incarnation = incarnation;
        heard.Beat = BeatAt(100s);
        heard.Arrival = 100s;
        path.OnBeat(heard);
    }

    PeerTable mesh{"ground", 1};
    PeerTable modem{"ground", 1};
    PathChoice choice{2};
    PeersOverPaths peers{{&mesh, &modem}, choice};
};

TEST_F(PeersOverPathsTest, ANodeWhoseGoodbyeCameByOnePathAloneHasLeft)
{
    HearOn(mesh, 5);
    HearOn(modem, 5);
    modem.OnLeft("uav1", 5);
    ASSERT_NE(peers.Find("uav1"), nullptr);
    EXPECT_EQ(peers.Find("uav1")->State, Gateway::NodeState::UP) << "it is heard by the other path";
    mesh.Advance(110s);
    EXPECT_EQ(peers.Find("uav1")->State, Gateway::NodeState::LOST);
    EXPECT_EQ(peers.Find("uav1")->Reason, PeerTable::Left);
}

TEST_F(PeersOverPathsTest, AGoodbyeOfAFormerIncarnationIsNotThatOfThePresentOne)
{
    HearOn(modem, 5);
    modem.OnLeft("uav1", 5);
    HearOn(mesh, 6);
    mesh.Advance(110s);
    ASSERT_NE(peers.Find("uav1"), nullptr);
    EXPECT_EQ(peers.Find("uav1")->State, Gateway::NodeState::LOST);
    EXPECT_NE(peers.Find("uav1")->Reason, PeerTable::Left);
}

}  // namespace
}  // namespace Rabit
