#include "report/LinkStrains.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "BeatSamples.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Kind = LinkStrain::Kind;
using Ns = std::chrono::nanoseconds;

class LinkStrainsTest : public ::testing::Test
{
protected:
    LinkStrainsTest() : uav1(Hear("uav1")), uav2(Hear("uav2")) {}

    std::uint32_t Hear(const std::string &node)
    {
        HeardBeat heard;
        heard.Node = node;
        heard.Incarnation = 5;
        heard.Beat = BeatAt(1s);
        heard.Arrival = 1s;
        peers.OnBeat(heard);
        return peers.Find(node)->Tag;
    }

    Gateway::LinkStatus &LinkTo(const std::string &node, const std::string &queue = "Commands")
    {
        Gateway::LinkStatus &link = fleet.links.emplace_back();
        link.node = node;
        link.queue = queue;
        return link;
    }

    Gateway::InboundStatus &FullStreamFrom(const std::string &node)
    {
        Gateway::InboundStatus &stream = fleet.inbound.emplace_back();
        stream.node = node;
        stream.queue = "Commands";
        stream.held_back = true;
        return stream;
    }

    std::vector<LinkStrain> Look(Ns now) { return strains.Look(fleet, peers, now); }

    PeerTable peers{"ground", 7};
    const std::uint32_t uav1;
    const std::uint32_t uav2;
    Gateway::Fleet fleet;
    LinkStrains strains;
};

TEST_F(LinkStrainsTest, LinksThatGetOnAreNotWorthAWord)
{
    Gateway::LinkStatus &link = LinkTo("uav1");
    link.fill = 0.49;
    link.outbox = 490;
    link.delivered = 100000;
    link.expired = 5;
    EXPECT_THAT(Look(10s), IsEmpty());
}

TEST_F(LinkStrainsTest, AnOutboxIsToldFromHalfFullOn)
{
    LinkTo("uav1").fill = 0.5;
    EXPECT_THAT(Look(10s), ElementsAre(LinkStrain{uav1, Kind::Filling, 50, 0}));
    fleet.links[0].fill = 1.0;
    EXPECT_THAT(Look(11s), ElementsAre(LinkStrain{uav1, Kind::Filling, 100, 0}));
    fleet.links[0].fill = 0.0;
    EXPECT_THAT(Look(12s), IsEmpty());
}

TEST_F(LinkStrainsTest, WhatWasRefusedIsToldForHalfAMinuteAfterTheLastOfIt)
{
    Gateway::LinkStatus &link = LinkTo("uav1");
    link.refused_full = 3;
    EXPECT_THAT(Look(100s), ElementsAre(LinkStrain{uav1, Kind::Filling, 0, 3}));
    link.refused_full = 5;
    EXPECT_THAT(Look(120s), ElementsAre(LinkStrain{uav1, Kind::Filling, 0, 5}));
    EXPECT_THAT(Look(150s), ElementsAre(LinkStrain{uav1, Kind::Filling, 0, 5}));
    EXPECT_THAT(Look(151s), IsEmpty());
    link.refused_full = 6;
    EXPECT_THAT(Look(200s), ElementsAre(LinkStrain{uav1, Kind::Filling, 0, 1}));
}

TEST_F(LinkStrainsTest, WhatCameInDoubtIsToldForHalfAMinute)
{
    LinkTo("uav2").in_doubt = 2;
    EXPECT_THAT(Look(100s), ElementsAre(LinkStrain{uav2, Kind::InDoubt, 0, 2}));
    EXPECT_THAT(Look(131s), IsEmpty());
}

TEST_F(LinkStrainsTest, AQueueThatIsFullIsToldOnceItHasBeenForTwoSeconds)
{
    FullStreamFrom("uav1");
    EXPECT_THAT(Look(10s), IsEmpty());
    EXPECT_THAT(Look(12s), ElementsAre(LinkStrain{uav1, Kind::HeldBack, 0, 0}));
    fleet.inbound[0].held_back = false;
    EXPECT_THAT(Look(13s), IsEmpty());
    fleet.inbound[0].held_back = true;
    EXPECT_THAT(Look(14s), IsEmpty()) << "it had room in between";
}

TEST_F(LinkStrainsTest, SeveralQueuesOfANodeAreToldAsOne)
{
    LinkTo("uav1", "A").fill = 0.6;
    LinkTo("uav1", "B").fill = 0.9;
    fleet.links[0].refused_full = 60000;
    fleet.links[1].refused_full = 60000;
    EXPECT_THAT(Look(10s), ElementsAre(LinkStrain{uav1, Kind::Filling, 90, 65535}));
}

TEST_F(LinkStrainsTest, TheWorstComesFirst)
{
    FullStreamFrom("uav1");
    LinkTo("uav1").fill = 0.8;
    LinkTo("uav2").refused_full = 1;
    fleet.links[1].in_doubt = 1;
    Look(10s);
    EXPECT_THAT(Look(12s),
                ElementsAre(LinkStrain{uav2, Kind::Filling, 0, 1}, LinkStrain{uav1, Kind::Filling, 80, 0},
                            LinkStrain{uav2, Kind::InDoubt, 0, 1}, LinkStrain{uav1, Kind::HeldBack, 0, 0}));
}

TEST_F(LinkStrainsTest, ALinkThatIsForgottenCountsFromNothingWhenItComesAgain)
{
    LinkTo("uav1").in_doubt = 5;
    Look(10s);
    fleet.links.clear();
    EXPECT_THAT(Look(11s), IsEmpty());
    LinkTo("uav1").in_doubt = 1;
    EXPECT_THAT(Look(100s), ElementsAre(LinkStrain{uav1, Kind::InDoubt, 0, 1}));
}

TEST_F(LinkStrainsTest, OfANodeThatNobodyHasHeardNothingIsSaid)
{
    LinkTo("nobody").fill = 1.0;
    FullStreamFrom("nobody");
    Look(10s);
    EXPECT_THAT(Look(20s), IsEmpty());
}

}  // namespace
}  // namespace Rabit
