#include "presence/PeerTable.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "wire/Announcements.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Gateway::NodeState;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Ns = std::chrono::nanoseconds;

// The peers' monotonic clocks are this far from ours.
constexpr Ns ClockDistance = 1000s;

Gateway::Beat BeatOf(const std::string &node, std::uint64_t incarnation, Ns sent)
{
    Gateway::Beat beat;
    beat.node = node;
    beat.incarnation = incarnation;
    beat.monotonic_ns = (sent + ClockDistance).count();
    beat.utc_ns = (sent + 1'700'000'000s).count();
    return beat;
}

Gateway::Announcement AnnouncementOf(const std::string &node, std::uint64_t incarnation)
{
    Gateway::Announcement announcement;
    announcement.node = node;
    announcement.incarnation = incarnation;
    return announcement;
}

class PeerTableTest : public ::testing::Test
{
protected:
    PeerTable::Change Hear(const std::string &node, std::uint64_t incarnation, Ns at)
    {
        table.Advance(at);
        return table.OnBeat(BeatOf(node, incarnation, at), at);
    }

    NodeState StateOf(const std::string &node) const { return table.Find(node)->State; }

    PeerTable table{"ground", 7};
};

TEST_F(PeerTableTest, ANodeIsUpWithItsFirstBeat)
{
    const PeerTable::Change change = Hear("uav1", 5, 1s);
    EXPECT_TRUE(change.NewLife);
    EXPECT_TRUE(change.State);
    EXPECT_EQ(StateOf("uav1"), NodeState::UP);
}

TEST_F(PeerTableTest, AnAnnouncementAloneDoesNotMakeANodeLive)
{
    EXPECT_TRUE(table.OnAnnouncement(AnnouncementOf("uav1", 5), 1s).Offers);
    EXPECT_TRUE(table.Heard().empty());
}

TEST_F(PeerTableTest, SilenceMakesANodeStaleAndThenLost)
{
    Hear("uav1", 5, 1s);
    EXPECT_FALSE(table.Advance(2500ms).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::UP);
    EXPECT_TRUE(table.Advance(2501ms).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::STALE);
    EXPECT_FALSE(table.Advance(4500ms).State);
    EXPECT_TRUE(table.Advance(4501ms).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
    EXPECT_EQ(table.Find("uav1")->Reason, "not heard for 3.5 seconds");
}

TEST_F(PeerTableTest, SaysWhenItNextChanges)
{
    EXPECT_FALSE(table.NextChange().has_value());
    Hear("uav1", 5, 1s);
    ASSERT_TRUE(table.NextChange().has_value());
    EXPECT_FALSE(table.Advance(*table.NextChange() - 1ns).State);
    EXPECT_TRUE(table.Advance(*table.NextChange()).State);
    EXPECT_TRUE(table.Advance(*table.NextChange()).State);
    EXPECT_FALSE(table.NextChange().has_value());
}

TEST_F(PeerTableTest, ABeatAfterALossMakesTheNodeUpAgainInTheSameLife)
{
    Hear("uav1", 5, 1s);
    table.Advance(60s);
    const PeerTable::Change change = Hear("uav1", 5, 61s);
    EXPECT_TRUE(change.State);
    EXPECT_FALSE(change.NewLife);
    EXPECT_EQ(StateOf("uav1"), NodeState::UP);
}

TEST_F(PeerTableTest, ABeatThatWasHeldUpOnTheWayDoesNotMakeItsNodeLookLive)
{
    Hear("uav1", 5, 1s);
    Hear("uav1", 5, 2s);
    table.Advance(62s);
    const PeerTable::Change change = table.OnBeat(BeatOf("uav1", 5, 3s), 62s);
    EXPECT_FALSE(change.State);
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
}

// A beat of a peer whose monotonic clock stood still for `behind` in all, which echoes one that we sent so
// long before it came.
Gateway::Beat EchoingBeat(Ns sent, Ns behind, Ns arrival, Ns roundTrip)
{
    Gateway::Beat beat = BeatOf("uav1", 5, sent - behind);
    Gateway::BeatEcho echo;
    echo.node = "ground";
    echo.incarnation = 7;
    echo.monotonic_ns = (arrival - roundTrip).count();
    beat.echoes.push_back(echo);
    return beat;
}

TEST_F(PeerTableTest, ANodeWhoseClockStoodStillIsUpWithTheFirstBeatThatEchoesOneSentSince)
{
    for (Ns sent = 1s; sent < 20s; sent += 500ms)
    {
        table.OnBeat(EchoingBeat(sent, 0s, sent + 10ms, 20ms), sent + 10ms);
    }
    table.Advance(120s);
    EXPECT_FALSE(table.OnBeat(BeatOf("uav1", 5, 20s), 120s).State) << "it may have been held up";
    const PeerTable::Change change = table.OnBeat(EchoingBeat(120500ms, 100s, 120510ms, 20ms), 120510ms);
    EXPECT_TRUE(change.State);
    EXPECT_FALSE(change.NewLife);
    EXPECT_EQ(StateOf("uav1"), NodeState::UP);
    EXPECT_EQ(table.Find("uav1")->LastHeard, Ns(120500ms));
}

TEST_F(PeerTableTest, ABeatThatWasHeldUpWithItsEchoDoesNotMakeItsNodeLookLive)
{
    for (Ns sent = 1s; sent < 20s; sent += 500ms)
    {
        table.OnBeat(EchoingBeat(sent, 0s, sent + 10ms, 20ms), sent + 10ms);
    }
    table.Advance(120s);
    for (Ns sent = 20s; sent < 25s; sent += 500ms)
    {
        const Ns arrival = sent + 100s;
        EXPECT_FALSE(table.OnBeat(EchoingBeat(sent, 0s, arrival, 100s + 10ms), arrival).State);
    }
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
}

TEST_F(PeerTableTest, ADuplicateOfABeatChangesNothing)
{
    Hear("uav1", 5, 1s);
    Hear("uav1", 5, 2s);
    const Ns heard = table.Find("uav1")->LastHeard;
    table.OnBeat(BeatOf("uav1", 5, 1s), 3s);
    EXPECT_EQ(table.Find("uav1")->LastHeard, heard);
}

TEST_F(PeerTableTest, AHigherIncarnationIsANewLifeAndForgetsTheOldOffers)
{
    Hear("uav1", 5, 1s);
    table.OnAnnouncement(AnnouncementOf("uav1", 5), 1s);
    EXPECT_TRUE(Hear("uav1", 6, 2s).NewLife);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 6u);
    EXPECT_FALSE(table.Find("uav1")->Offers.has_value());
}

TEST_F(PeerTableTest, KeepsAnAnnouncementThatOvertookTheFirstBeatOfItsLife)
{
    Hear("uav1", 5, 1s);
    table.OnAnnouncement(AnnouncementOf("uav1", 6), 2s);
    Hear("uav1", 6, 2s);
    ASSERT_TRUE(table.Find("uav1")->Offers.has_value());
    EXPECT_EQ(table.Find("uav1")->Offers->incarnation, 6u);
}

TEST_F(PeerTableTest, AStragglerOfAnEarlierLifeIsIgnored)
{
    Hear("uav1", 6, 1s);
    EXPECT_FALSE(Hear("uav1", 5, 1100ms).State);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 6u);
    EXPECT_FALSE(table.OnAnnouncement(AnnouncementOf("uav1", 5), 1200ms).Offers);
}

TEST_F(PeerTableTest, ALowerIncarnationIsTakenOnceTheHigherOneHasFallenSilent)
{
    Hear("uav1", 6, 1s);
    EXPECT_TRUE(Hear("uav1", 5, 3s).NewLife);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 5u);
}

TEST_F(PeerTableTest, ANodeThatSaysGoodbyeIsLostAtOnce)
{
    Hear("uav1", 5, 1s);
    Gateway::Announcement goodbye = AnnouncementOf("uav1", 5);
    goodbye.leaving = true;
    EXPECT_TRUE(table.OnAnnouncement(goodbye, 1100ms).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
    EXPECT_EQ(table.Find("uav1")->Reason, "left");
}

TEST_F(PeerTableTest, TheGoodbyeOfAnEarlierLifeDoesNotEndTheNextOne)
{
    Hear("uav1", 5, 1s);
    Hear("uav1", 6, 2s);
    Gateway::Announcement goodbye = AnnouncementOf("uav1", 5);
    goodbye.leaving = true;
    EXPECT_FALSE(table.OnAnnouncement(goodbye, 2100ms).State);
    EXPECT_FALSE(table.OnLeft("uav1", 5).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::UP);
}

TEST_F(PeerTableTest, TwoLiveNodesOfOneNameAreReported)
{
    for (int i = 1; i <= 4; ++i)
    {
        Hear("uav1", 6, i * 500ms);
        Hear("uav1", 5, i * 500ms + 100ms);
    }
    EXPECT_TRUE(table.Find("uav1")->Twice);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 6u);
}

TEST_F(PeerTableTest, ARestartIsNotTakenForTwoNodes)
{
    for (int i = 1; i <= 10; ++i)
    {
        Hear("uav1", 5, i * 500ms);
    }
    for (int i = 11; i <= 20; ++i)
    {
        Hear("uav1", 6, i * 500ms);
    }
    EXPECT_FALSE(table.Find("uav1")->Twice);
}

TEST_F(PeerTableTest, ALiveNodeWithThisNodesNameIsReportedUntilItIsGone)
{
    for (int i = 1; i <= 3; ++i)
    {
        Hear("ground", 99, i * 500ms);
    }
    EXPECT_TRUE(table.OwnNameTwice());
    EXPECT_TRUE(table.Heard().empty());
    table.Advance(10s);
    EXPECT_FALSE(table.OwnNameTwice());
}

// Fills the table with nodes that were heard; n0 first.
class FullPeerTableTest : public PeerTableTest
{
protected:
    static std::string Name(std::size_t i) { return std::string("n").append(std::to_string(i)); }

    FullPeerTableTest()
    {
        for (std::size_t i = 0; i < PeerTable::MaximumPeers; ++i)
        {
            Hear(Name(i), 5, Ns(1s) + Ns(static_cast<Ns::rep>(i)));
        }
    }
};

TEST_F(FullPeerTableTest, ANewNodeIsDroppedAndCountedWhileAllAreLive)
{
    EXPECT_FALSE(Hear("late", 5, 2s).NewLife);
    EXPECT_EQ(table.Find("late"), nullptr);
    EXPECT_EQ(table.CrowdedOut(), 1u);
    EXPECT_EQ(table.Forgotten(), 0u);
}

TEST_F(FullPeerTableTest, OnceAllAreLostTheOneLostForLongestMakesRoomAndIsNamed)
{
    const PeerTable::Change change = Hear("late", 5, 60s);
    EXPECT_TRUE(change.NewLife);
    EXPECT_EQ(change.Forgotten, std::vector<std::string>{"n0"});
    EXPECT_EQ(table.Find("n0"), nullptr);
    EXPECT_EQ(table.Forgotten(), 1u);
}

TEST_F(FullPeerTableTest, AnAnnouncementAloneDoesNotMakeANodeForgottenThatWasHeard)
{
    table.Advance(60s);
    EXPECT_TRUE(table.OnAnnouncement(AnnouncementOf("stranger", 5), 60s).Forgotten.empty());
    EXPECT_EQ(table.Find("stranger"), nullptr);
    EXPECT_EQ(table.CrowdedOut(), 1u);
}

TEST(PeerTable, ACrowdOfNamesThatWereNeverHeardPushesOutNoneThatWas)
{
    PeerTable table("ground", 7);
    table.OnBeat(BeatOf("uav1", 5, 1s), 1s);
    table.Advance(60s);
    for (std::size_t i = 0; i < 3 * PeerTable::MaximumPeers; ++i)
    {
        table.OnAnnouncement(AnnouncementOf(std::string("x").append(std::to_string(i)), 5), 60s);
    }
    EXPECT_NE(table.Find("uav1"), nullptr);
    EXPECT_TRUE(table.OnBeat(BeatOf("uav2", 5, 61s), 61s).NewLife);
    EXPECT_NE(table.Find("uav1"), nullptr);
}

TEST(PeerTable, ANodeThatIsNeededIsNotForgotten)
{
    PeerTable table("ground", 7, [](const std::string &node) { return node == "n0"; });
    for (std::size_t i = 0; i < PeerTable::MaximumPeers; ++i)
    {
        table.OnBeat(BeatOf(std::string("n").append(std::to_string(i)), 5, 1s), 1s);
    }
    table.Advance(60s);
    EXPECT_EQ(table.OnBeat(BeatOf("late", 5, 60s), 60s).Forgotten, std::vector<std::string>{"n1"});
}

TEST_F(PeerTableTest, MeasuresTheRoundTripFromAnEchoOfThisLifeAlone)
{
    Gateway::Beat beat = BeatOf("uav1", 5, 10s);
    Gateway::BeatEcho echo;
    echo.node = "ground";
    echo.incarnation = 6;
    echo.monotonic_ns = Ns(9s).count();
    beat.echoes.push_back(echo);
    table.OnBeat(beat, 10s);
    EXPECT_FALSE(table.Find("uav1")->Clock.RoundTrip().has_value());

    beat = BeatOf("uav1", 5, 11s);
    echo.incarnation = 7;
    echo.monotonic_ns = Ns(10700ms).count();
    echo.held_ns = Ns(290ms).count();
    beat.echoes.push_back(echo);
    table.OnBeat(beat, 11s);
    EXPECT_EQ(table.Find("uav1")->Clock.RoundTrip(), Ns(10ms));
}

TEST_F(PeerTableTest, EchoesTakeTurnsWhenThereAreMoreNodesThanRoom)
{
    for (const char *node : {"a", "b", "c"})
    {
        Hear(node, 1, 1s);
    }
    const auto namesOf = [](const std::vector<Gateway::BeatEcho> &echoes)
    {
        std::string names;
        for (const auto &echo : echoes)
        {
            names += echo.node;
        }
        return names;
    };
    EXPECT_EQ(namesOf(table.NextEchoes(1s, 2)), "ab");
    EXPECT_EQ(namesOf(table.NextEchoes(1500ms, 2)), "c");
    EXPECT_EQ(namesOf(table.NextEchoes(4999ms, 8)), "");
    // Those that are due again.
    for (const char *node : {"a", "b", "c"})
    {
        Hear(node, 1, 5s);
    }
    EXPECT_EQ(namesOf(table.NextEchoes(5s, 8)), "ab");
    EXPECT_EQ(namesOf(table.NextEchoes(5500ms, 8)), "c");
}

TEST_F(PeerTableTest, ANewLifeIsEchoedAtOnce)
{
    Hear("uav1", 5, 1s);
    EXPECT_EQ(table.NextEchoes(1s, 2).size(), 1u);
    Hear("uav1", 6, 2s);
    EXPECT_EQ(table.NextEchoes(2s, 2).size(), 1u);
}

class OffersTest : public PeerTableTest
{
protected:
    void HearOffering(const std::string &node, std::uint32_t offers, Ns at)
    {
        Gateway::Beat beat = BeatOf(node, 5, at);
        beat.offers = offers;
        table.Advance(at);
        table.OnBeat(beat, at);
    }

    const Gateway::Announcement announcement = AnnouncementOf("uav1", 5);
    const std::uint32_t digest = Announcements::DigestOf(announcement);
};

TEST_F(OffersTest, WhoLacksAnAnnouncementAsksForItAfterAWhile)
{
    HearOffering("uav1", digest, 1s);
    EXPECT_THAT(table.NextWanted(1299ms, 4), IsEmpty());
    HearOffering("uav1", digest, 1300ms);
    EXPECT_THAT(table.NextWanted(1300ms, 4), ElementsAre("uav1"));
    // Until it has come.
    EXPECT_THAT(table.NextWanted(1800ms, 4), ElementsAre("uav1"));
    table.OnAnnouncement(announcement, 1900ms);
    HearOffering("uav1", digest, 2s);
    EXPECT_THAT(table.NextWanted(2300ms, 4), IsEmpty());
}

TEST_F(OffersTest, WhoHasAnotherAnnouncementThanThePresentOneAsks)
{
    Gateway::Announcement former = announcement;
    former.publishes.emplace_back();
    table.OnAnnouncement(former, 1s);
    HearOffering("uav1", digest, 1s);
    EXPECT_THAT(table.NextWanted(1300ms, 4), ElementsAre("uav1"));
}

TEST_F(OffersTest, NobodyAsksOneThatIsLost)
{
    HearOffering("uav1", digest, 1s);
    table.Advance(5s);
    EXPECT_THAT(table.NextWanted(5s, 4), IsEmpty());
}

TEST_F(OffersTest, ThoseWhoAreAskedTakeTurns)
{
    for (const char *node : {"a", "b", "c"})
    {
        HearOffering(node, digest, 1s);
    }
    EXPECT_THAT(table.NextWanted(1500ms, 2), ElementsAre("a", "b"));
    EXPECT_THAT(table.NextWanted(1500ms, 2), ElementsAre("c", "a"));
}

TEST_F(PeerTableTest, NamesFromTheNetworkCannotFillTheMemory)
{
    for (std::size_t i = 0; i < 2 * PeerTable::MaximumPeers; ++i)
    {
        Hear("node" + std::to_string(i), 1, 1s + Ns(i));
    }
    EXPECT_EQ(table.Heard().size(), PeerTable::MaximumPeers);
    table.Advance(60s);
    Hear("late", 1, 60s);
    EXPECT_EQ(table.Heard().size(), PeerTable::MaximumPeers);
    EXPECT_EQ(StateOf("late"), NodeState::UP);
}

}  // namespace
}  // namespace Rabit
