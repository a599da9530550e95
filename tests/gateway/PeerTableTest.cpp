#include "presence/PeerTable.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "names/NodeTag.h"
#include "wire/Announcements.h"
#include "wire/BeatNews.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Gateway::NodeState;
using ::testing::ElementsAre;
using Ns = std::chrono::nanoseconds;

// The peers' source clocks are this far from our monotonic one.
constexpr Ns ClockDistance = 1000s;
constexpr Ns Period = 500ms;

HeardBeat BeatOf(const std::string &node, std::uint64_t incarnation, Ns sent, Ns arrival)
{
    HeardBeat heard;
    heard.Node = node;
    heard.Incarnation = incarnation;
    heard.Utc = (sent + 1'700'000'000s).count();
    heard.Beat.source_ns = (sent + ClockDistance).count();
    heard.Beat.next_ms = static_cast<std::uint16_t>(Period / 1ms);
    heard.Arrival = arrival;
    return heard;
}

HeardBeat BeatOf(const std::string &node, std::uint64_t incarnation, Ns sent)
{
    return BeatOf(node, incarnation, sent, sent);
}

// Adds an echo of the beat that this node sent at `sent`.
void Echo(HeardBeat &heard, Ns sent, std::uint64_t incarnation = 7)
{
    Gateway::BeatEcho echo;
    echo.node = NodeTagOf("ground", incarnation);
    echo.beat = static_cast<std::uint32_t>(sent.count());
    NewsOf(heard.Beat).echoes.push_back(echo);
}

class PeerTableTest : public ::testing::Test
{
protected:
    PeerTable::Change Hear(const std::string &node, std::uint64_t incarnation, Ns at)
    {
        table.Advance(at);
        return table.OnBeat(BeatOf(node, incarnation, at));
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
    EXPECT_EQ(table.Find("uav1")->Reason, "no beat within its limit of 3.5 s");
}

TEST_F(PeerTableTest, ANodeIsLostAfterTheStatedTime)
{
    table.SetLostAfter(2s);
    Hear("uav1", 5, 1s);
    EXPECT_TRUE(table.Advance(2501ms).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::STALE);
    EXPECT_FALSE(table.Advance(3s).State);
    ASSERT_TRUE(table.NextChange().has_value());
    EXPECT_TRUE(table.Advance(*table.NextChange()).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
    EXPECT_EQ(table.Find("uav1")->Reason, "no beat within its limit of 2 s");
}

TEST_F(PeerTableTest, ANodeWithRareBeatsIsNotLostBeforeThreeOfThemAreMissing)
{
    table.SetLostAfter(2s);
    HeardBeat rare = BeatOf("uav1", 5, 1s);
    rare.Beat.next_ms = 2000;
    table.OnBeat(rare);
    table.Advance(7s);
    EXPECT_EQ(StateOf("uav1"), NodeState::UP);
    table.Advance(7001ms);
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
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

TEST_F(PeerTableTest, ANodeThatFallsSilentTurnsStaleInTimeHoweverOftenOthersBeat)
{
    Hear("uav1", 5, 1s);
    for (Ns at = 1200ms; at <= 2400ms; at += 300ms)
    {
        Hear("uav2", 5, at);
    }
    EXPECT_FALSE(table.Advance(2500ms).State);
    EXPECT_TRUE(table.Advance(2501ms).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::STALE);
    EXPECT_EQ(StateOf("uav2"), NodeState::UP);
}

TEST_F(PeerTableTest, ABeatThatAnnouncesTheNextSoonerBringsTheNextChangeForward)
{
    HeardBeat slow = BeatOf("uav1", 5, 1s);
    slow.Beat.next_ms = 5000;
    table.OnBeat(slow);
    HeardBeat quick = BeatOf("uav1", 5, 2s);
    quick.Beat.next_ms = 200;
    table.OnBeat(quick);
    EXPECT_FALSE(table.Advance(2600ms).State);
    EXPECT_TRUE(table.Advance(2601ms).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::STALE);
}

TEST_F(PeerTableTest, TheNextChangeMovesOnWhenItsTimeHasComeAndTheNodeWasHeard)
{
    Hear("uav1", 5, 1s);
    Hear("uav1", 5, 2s);
    EXPECT_FALSE(table.Advance(2501ms).State);
    EXPECT_EQ(table.NextChange(), 3500ms + 1ns);
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
    const PeerTable::Change change = table.OnBeat(BeatOf("uav1", 5, 3s, 62s));
    EXPECT_FALSE(change.State);
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
}

class EchoTest : public PeerTableTest
{
protected:
    // Hears a beat of a peer whose clocks stood still for `behind` in all. The beat echoes one that this
    // node sent `roundTrip` before the arrival.
    PeerTable::Change HearEchoing(Ns sent, Ns behind, Ns arrival, Ns roundTrip)
    {
        table.NoteSent((arrival - roundTrip).count(), arrival - roundTrip);
        HeardBeat heard = BeatOf("uav1", 5, sent - behind, arrival);
        Echo(heard, arrival - roundTrip);
        return table.OnBeat(heard);
    }

    std::optional<Ns> RoundTrip() const { return table.Find("uav1")->Clock.RoundTrip(); }
};

TEST_F(EchoTest, ANodeWhoseClockStoodStillIsUpWithTheFirstBeatThatEchoesOneSentSince)
{
    for (Ns sent = 1s; sent < 20s; sent += 500ms)
    {
        HearEchoing(sent, 0s, sent + 10ms, 20ms);
    }
    table.Advance(120s);
    EXPECT_FALSE(table.OnBeat(BeatOf("uav1", 5, 20s, 120s)).State) << "it may have been held up";
    const PeerTable::Change change = HearEchoing(120500ms, 100s, 120510ms, 20ms);
    EXPECT_TRUE(change.State);
    EXPECT_FALSE(change.NewLife);
    EXPECT_EQ(StateOf("uav1"), NodeState::UP);
    EXPECT_EQ(table.Find("uav1")->LastHeard, Ns(120500ms));
}

TEST_F(EchoTest, ABeatThatWasHeldUpWithItsEchoDoesNotMakeItsNodeLookLive)
{
    for (Ns sent = 1s; sent < 20s; sent += 500ms)
    {
        HearEchoing(sent, 0s, sent + 10ms, 20ms);
    }
    table.Advance(120s);
    for (Ns sent = 20s; sent < 25s; sent += 500ms)
    {
        EXPECT_FALSE(HearEchoing(sent, 0s, sent + 100s, 100s + 10ms).State);
    }
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
}

TEST_F(EchoTest, MeasuresTheRoundTrip)
{
    table.NoteSent(Ns(10700ms).count(), 10700ms);
    HeardBeat heard = BeatOf("uav1", 5, 11s);
    Echo(heard, 10700ms);
    NewsOf(heard.Beat).echoes[0].held_us = 290'000;
    table.OnBeat(heard);
    EXPECT_EQ(RoundTrip(), Ns(10ms));
}

TEST_F(EchoTest, AnEchoOfAnEarlierLifeMeansNothing)
{
    table.NoteSent(Ns(9s).count(), 9s);
    HeardBeat heard = BeatOf("uav1", 5, 10s);
    Echo(heard, 9s, 6);
    table.OnBeat(heard);
    EXPECT_EQ(RoundTrip(), std::nullopt);
}

TEST_F(EchoTest, AnEchoOfABeatThatThisNodeHasNotSentMeansNothing)
{
    table.NoteSent(Ns(9s).count(), 9s);
    HeardBeat heard = BeatOf("uav1", 5, 10s);
    Echo(heard, 9s + 1ns);
    table.OnBeat(heard);
    EXPECT_EQ(RoundTrip(), std::nullopt);
}

TEST_F(EchoTest, AnEchoThatWasHeldForLongerThanItWasOnItsWayMeansNothing)
{
    table.NoteSent(Ns(9s).count(), 9s);
    HeardBeat heard = BeatOf("uav1", 5, 10s);
    Echo(heard, 9s);
    NewsOf(heard.Beat).echoes[0].held_us = 1'000'001;
    table.OnBeat(heard);
    EXPECT_EQ(RoundTrip(), std::nullopt);
}

TEST_F(PeerTableTest, ADuplicateOfABeatChangesNothing)
{
    Hear("uav1", 5, 1s);
    Hear("uav1", 5, 2s);
    const Ns heard = table.Find("uav1")->LastHeard;
    table.OnBeat(BeatOf("uav1", 5, 1s, 3s));
    EXPECT_EQ(table.Find("uav1")->LastHeard, heard);
}

TEST_F(PeerTableTest, AHigherIncarnationIsANewLife)
{
    Hear("uav1", 5, 1s);
    EXPECT_TRUE(Hear("uav1", 6, 2s).NewLife);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 6u);
}

TEST_F(PeerTableTest, AStragglerOfAnEarlierLifeIsIgnored)
{
    Hear("uav1", 6, 1s);
    EXPECT_FALSE(Hear("uav1", 5, 1100ms).State);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 6u);
}

TEST_F(PeerTableTest, ALowerIncarnationIsTakenOnceTheHigherOneHasFallenSilent)
{
    Hear("uav1", 6, 1s);
    EXPECT_FALSE(Hear("uav1", 5, 3s).NewLife) << "it may be an earlier life's straggler";
    EXPECT_TRUE(Hear("uav1", 5, 3500ms).NewLife);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 5u);
}

TEST_F(PeerTableTest, StragglersOfAnEarlierLifeDoNotReviveIt)
{
    Hear("uav1", 6, 1s);
    EXPECT_FALSE(table.OnBeat(BeatOf("uav1", 5, 500ms, 30s)).NewLife);
    EXPECT_FALSE(table.OnBeat(BeatOf("uav1", 5, 1000ms, 40s)).NewLife);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 6u);
}

TEST_F(PeerTableTest, ALowerIncarnationIsTakenSoonAfterTheGoodbyeOfTheHigherOne)
{
    Hear("uav1", 6, 1s);
    table.OnLeft("uav1", 6);
    Hear("uav1", 5, 1100ms);
    EXPECT_TRUE(Hear("uav1", 5, 1200ms).NewLife);
    EXPECT_EQ(table.Find("uav1")->Incarnation, 5u);
    EXPECT_EQ(StateOf("uav1"), NodeState::UP);
}

TEST_F(PeerTableTest, ANodeThatSaysGoodbyeIsLostAtOnce)
{
    Hear("uav1", 5, 1s);
    HeardBeat goodbye = BeatOf("uav1", 5, 1100ms);
    goodbye.Beat.leaving = true;
    EXPECT_TRUE(table.OnBeat(goodbye).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
    EXPECT_EQ(table.Find("uav1")->Reason, "left");
    EXPECT_FALSE(table.OnBeat(goodbye).State);
}

TEST_F(PeerTableTest, ABeatThatItsGoodbyeHasOvertakenDoesNotBringANodeBack)
{
    Hear("uav1", 5, 1s);
    HeardBeat goodbye = BeatOf("uav1", 5, 1200ms);
    goodbye.Beat.leaving = true;
    table.OnBeat(goodbye);
    EXPECT_FALSE(table.OnBeat(BeatOf("uav1", 5, 1100ms, 1300ms)).State);
    EXPECT_EQ(StateOf("uav1"), NodeState::LOST);
}

TEST_F(PeerTableTest, TheGoodbyeOfANodeThatWasNeverHeardIsNoNews)
{
    HeardBeat goodbye = BeatOf("uav1", 5, 1s);
    goodbye.Beat.leaving = true;
    EXPECT_FALSE(table.OnBeat(goodbye).State);
    EXPECT_EQ(table.Find("uav1"), nullptr);
}

TEST_F(PeerTableTest, TheGoodbyeOfAnEarlierLifeDoesNotEndTheNextOne)
{
    Hear("uav1", 5, 1s);
    Hear("uav1", 6, 2s);
    HeardBeat goodbye = BeatOf("uav1", 5, 2100ms);
    goodbye.Beat.leaving = true;
    EXPECT_FALSE(table.OnBeat(goodbye).State);
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

TEST_F(PeerTableTest, WhereTwoNodesOfOneNameRunIsKnownOnceTheySaySoAndForgottenWithTheTwin)
{
    const auto hear =
        [this](const std::string &node, std::uint64_t incarnation, Ns at, const std::string &place)
    {
        HeardBeat heard = BeatOf(node, incarnation, at);
        if (!place.empty())
        {
            NewsOf(heard.Beat).parts.emplace_back().bytes.assign(place.begin(), place.end());
        }
        table.OnBeat(heard);
    };
    for (int i = 1; i <= 4; ++i)
    {
        hear("uav1", 6, i * 500ms, i == 3 ? "host a" : "");
        hear("uav1", 5, i * 500ms + 100ms, i == 4 ? "host\nb" : "");
        hear("ground", 99, i * 500ms, i == 2 ? "host c" : "");
    }
    EXPECT_EQ(table.Find("uav1")->Place, "host a");
    EXPECT_EQ(table.Find("uav1")->TwinPlace, "host?b");
    EXPECT_EQ(table.OwnTwinPlace(), "host c");
    table.Advance(20s);
    EXPECT_EQ(table.Find("uav1")->TwinPlace, "");
    EXPECT_EQ(table.OwnTwinPlace(), "");
    EXPECT_EQ(table.Malformed(), 0u);
}

TEST_F(PeerTableTest, OfTwoNodesOfOneNameTheOneThatTakesAHigherIncarnationIsNotNamedTwice)
{
    const auto hear = [this](std::uint64_t incarnation, Ns at, const std::string &place)
    {
        HeardBeat heard = BeatOf("uav1", incarnation, at);
        NewsOf(heard.Beat).parts.emplace_back().bytes.assign(place.begin(), place.end());
        table.OnBeat(heard);
    };
    for (int i = 1; i <= 4; ++i)
    {
        hear(6, i * 500ms, "process 1");
        hear(5, i * 500ms + 100ms, "process 2");
    }
    ASSERT_TRUE(table.Find("uav1")->Twice);
    hear(7, 2500ms, "process 2");
    EXPECT_EQ(table.Find("uav1")->Place, "process 2");
    EXPECT_EQ(table.Find("uav1")->TwinPlace, "process 1");
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

TEST_F(PeerTableTest, ARestartWithALowerIncarnationIsNotTakenForTwoNodes)
{
    Hear("uav1", 6, 1s);
    for (int i = 1; i <= 10; ++i)
    {
        Hear("uav1", 5, 1s + i * 100ms);
        EXPECT_FALSE(table.Find("uav1")->Twice);
    }
}

TEST_F(PeerTableTest, TwoNodesWithLowerIncarnationsThanTheOneBeforeAreReported)
{
    Hear("uav1", 6, 1s);
    bool isReported = false;
    for (int i = 0; i <= 20; ++i)
    {
        Hear("uav1", i % 2 == 0 ? 4 : 5, 10s + i * 250ms);
        isReported = isReported || table.Find("uav1")->Twice;
    }
    EXPECT_NE(table.Find("uav1")->Incarnation, 6u);
    EXPECT_TRUE(isReported);
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

TEST(PeerTable, ANodeThatIsNeededIsNotForgotten)
{
    PeerTable table("ground", 7, [](const std::string &node) { return node == "n0"; });
    for (std::size_t i = 0; i < PeerTable::MaximumPeers; ++i)
    {
        table.OnBeat(BeatOf(std::string("n").append(std::to_string(i)), 5, 1s));
    }
    table.Advance(60s);
    EXPECT_EQ(table.OnBeat(BeatOf("late", 5, 60s)).Forgotten, std::vector<std::string>{"n1"});
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
            for (const char *node : {"a", "b", "c"})
            {
                names += echo.node == NodeTagOf(node, 1) ? node : "";
            }
        }
        return names;
    };
    EXPECT_EQ(namesOf(table.NextEchoes(1s, 2, 2)), "ab");
    EXPECT_EQ(namesOf(table.NextEchoes(1500ms, 2, 2)), "c");
    EXPECT_EQ(namesOf(table.NextEchoes(4999ms, 2, 8)), "");
    // All three are heard again, and their echoes are due again.
    for (const char *node : {"a", "b", "c"})
    {
        Hear(node, 1, 5s);
    }
    EXPECT_EQ(namesOf(table.NextEchoes(5s, 2, 8)), "ab");
    EXPECT_EQ(namesOf(table.NextEchoes(5500ms, 2, 8)), "c");
}

TEST_F(PeerTableTest, WhoBeatsSeldomEchoesWithEachEighthBeat)
{
    table.SetBeatPeriod(2s);
    Hear("uav1", 1, 1s);
    EXPECT_EQ(table.NextEchoes(1s, 2, 2).size(), 1u);
    Hear("uav1", 1, 16s);
    EXPECT_EQ(table.EchoesDue(16999ms, 2), 0u);
    EXPECT_EQ(table.NextEchoes(17s, 2, 2).size(), 1u);
    table.SetBeatPeriod(100ms);
    Hear("uav1", 1, 20s);
    EXPECT_EQ(table.EchoesDue(20999ms, 2), 0u);
    EXPECT_EQ(table.EchoesDue(21s, 2), 1u);
}

// All peers' beats come 10 s earlier than before by this node's clock, and report that this node's beats
// are old.
TEST_F(PeerTableTest, AllPeersAreEchoedAtOnceWhenThisNodesClockStoodStill)
{
    const auto nameOf = [](int i) { return std::string("n").append(std::to_string(i)); };
    for (Ns now = 1s; now < 20s; now += 500ms)
    {
        for (int i = 0; i < 50; ++i)
        {
            Hear(nameOf(i), 1, now);
        }
        table.NextEchoes(now, 2, 60);
    }
    for (int i = 0; i < 50; ++i)
    {
        table.OnBeat(BeatOf(nameOf(i), 1, 30s, 20s));
    }
    EXPECT_EQ(table.EchoesDue(20s, 0), 50u);
    EXPECT_EQ(table.NextEchoes(20s, 2, 30).size(), 30u);
    EXPECT_EQ(table.EchoesDue(20s, 0), 20u);
    EXPECT_EQ(table.NextEchoes(20s, 0, 30).size(), 20u);
    EXPECT_EQ(table.EchoesDue(20s, 0), 0u) << "once is enough";
    for (int i = 0; i < 50; ++i)
    {
        table.OnBeat(BeatOf(nameOf(i), 1, 30500ms, 20500ms));
    }
    EXPECT_EQ(table.EchoesDue(20500ms, 0), 0u);
}

TEST_F(PeerTableTest, BeatsThatComeALittleEarlierThanBeforeAreNoReasonForEchoes)
{
    for (Ns now = 1s; now < 20s; now += 500ms)
    {
        Hear("uav1", 1, now);
    }
    EXPECT_EQ(table.NextEchoes(20s, 2, 60).size(), 1u);
    table.OnBeat(BeatOf("uav1", 1, 20090ms, 20s));
    EXPECT_EQ(table.EchoesDue(20s, 2), 0u);
}

TEST_F(PeerTableTest, ANewLifeIsEchoedAtOnce)
{
    Hear("uav1", 5, 1s);
    EXPECT_EQ(table.NextEchoes(1s, 2, 2).size(), 1u);
    Hear("uav1", 6, 2s);
    EXPECT_EQ(table.NextEchoes(2s, 2, 2).size(), 1u);
}

class OffersTest : public PeerTableTest
{
protected:
    static Gateway::Announcement Publishing(const std::string &message)
    {
        Gateway::Announcement announcement;
        Gateway::PublishedMessage &published = announcement.publishes.emplace_back();
        published.message = message;
        published.type = "Uav::T";
        published.qos = "state";
        return announcement;
    }

    // Hears a beat that refers to this announcement, and carries it if `withThem`.
    PeerTable::Change HearOffering(const Gateway::Announcement &offers, bool withThem, Ns at,
                                   std::uint64_t incarnation = 5)
    {
        HeardBeat heard = BeatOf("uav1", incarnation, at);
        SetOffers(heard, offers, withThem);
        table.Advance(at);
        return table.OnBeat(heard);
    }

    static void SetOffers(HeardBeat &heard, const Gateway::Announcement &offers, bool withThem)
    {
        const std::vector<std::uint8_t> bytes = Announcements::Encode(offers);
        heard.Beat.offers = Announcements::DigestOf(bytes);
        if (withThem)
        {
            Gateway::AnnouncementPart &part = NewsOf(heard.Beat).parts.emplace_back();
            part.of = static_cast<std::uint16_t>(bytes.size());
            part.bytes = bytes;
        }
    }

    std::size_t Lacking(Ns now) const { return table.Missing().Due(now, 10); }

    const Gateway::Announcement pose = Publishing("Pose");
    const Gateway::Announcement other = Publishing("Other");
};

TEST_F(OffersTest, WhatIsWholeAndAsItsDigestSaysIsTaken)
{
    EXPECT_TRUE(HearOffering(pose, true, 1s).Offers);
    EXPECT_EQ(table.Find("uav1")->Offers, pose);
    EXPECT_TRUE(table.Find("uav1")->HasPresentOffers());
    EXPECT_EQ(Lacking(10s), 0u);
}

TEST_F(OffersTest, WhoLacksAnAnnouncementAsksForItAfterAWhile)
{
    HearOffering(pose, false, 1s);
    EXPECT_EQ(Lacking(1s + MissingOffers::AskAfter - 1ns), 0u);
    EXPECT_EQ(Lacking(1s + MissingOffers::AskAfter), 1u);
    HearOffering(pose, true, 1500ms);
    EXPECT_EQ(Lacking(10s), 0u);
}

TEST_F(OffersTest, WhoHasAnotherAnnouncementThanThePresentOneAsksAndKeepsItUntilThen)
{
    HearOffering(other, true, 1s);
    HearOffering(pose, false, 3s);
    EXPECT_EQ(table.Find("uav1")->Offers, other);
    EXPECT_FALSE(table.Find("uav1")->HasPresentOffers());
    EXPECT_EQ(Lacking(3100ms), 1u);
}

TEST_F(OffersTest, NobodyAsksOneThatIsLost)
{
    HearOffering(pose, false, 1s);
    table.Advance(5s);
    EXPECT_EQ(Lacking(5s), 0u);
}

TEST_F(OffersTest, ANodeThatRestartsAsItWasNeedNotBeAsked)
{
    HearOffering(pose, true, 1s);
    EXPECT_TRUE(HearOffering(pose, false, 2s, 6).NewLife);
    EXPECT_TRUE(table.Find("uav1")->HasPresentOffers());
    EXPECT_EQ(Lacking(10s), 0u);
}

TEST_F(OffersTest, ANodeThatRestartsWithOtherOffersHasNoneUntilTheyCome)
{
    HearOffering(pose, true, 1s);
    HearOffering(other, false, 2s, 6);
    EXPECT_EQ(table.Find("uav1")->Offers, std::nullopt);
    EXPECT_TRUE(HearOffering(other, true, 2100ms, 6).Offers);
}

TEST_F(OffersTest, WhoOffersSomethingElseWithEachBeatIsHeededOnceInAWhile)
{
    int taken = 0;
    for (int i = 0; i < 1000; ++i)
    {
        const Ns at = 1s + i * 10ms;
        taken +=
            HearOffering(Publishing(std::string("m").append(std::to_string(i))), true, at).Offers ? 1 : 0;
    }
    EXPECT_EQ(taken, 10);
}

TEST_F(OffersTest, AnAnnouncementThatIsNotWhatItsDigestSaysIsNotTakenAndCounted)
{
    HeardBeat heard = BeatOf("uav1", 5, 1s);
    SetOffers(heard, pose, true);
    heard.Beat.offers ^= 1;
    EXPECT_FALSE(table.OnBeat(heard).Offers);
    EXPECT_EQ(table.Malformed(), 1u);
}

TEST_F(OffersTest, AnAnnouncementThatIsNotPlausibleIsNotTakenAndCounted)
{
    Gateway::Announcement wrong = pose;
    wrong.publishes[0].qos = "splendid";
    EXPECT_FALSE(HearOffering(wrong, true, 1s).Offers);
    EXPECT_EQ(table.Malformed(), 1u);
}

class PeerStatesTest : public PeerTableTest
{
protected:
    void HearStates(std::uint16_t first, const std::vector<std::uint32_t> &versions, Ns at,
                    std::uint32_t offers = 1, std::uint64_t incarnation = 5)
    {
        HeardBeat heard = BeatOf("uav1", incarnation, at);
        heard.Beat.offers = offers;
        NewsOf(heard.Beat).first_state = first;
        NewsOf(heard.Beat).states = versions;
        table.OnBeat(heard);
    }

    const std::vector<std::uint32_t> &States() const { return table.Find("uav1")->States; }
};

TEST_F(PeerStatesTest, AreWhatItsBeatsHaveTold)
{
    HearStates(0, {11, 12}, 1s);
    HearStates(2, {13}, 2s);
    EXPECT_THAT(States(), ElementsAre(11, 12, 13));
    HearStates(1, {22, 23}, 3s);
    EXPECT_THAT(States(), ElementsAre(11, 22, 23));
}

TEST_F(PeerStatesTest, AreForgottenWithTheLife)
{
    HearStates(0, {11, 12}, 1s);
    HearStates(1, {22}, 2s, 1, 6);
    EXPECT_THAT(States(), ElementsAre(0, 22));
}

TEST_F(PeerStatesTest, AreForgottenWithTheAnnouncementWhoseOrderTheyHave)
{
    HearStates(0, {11, 12}, 1s);
    HearStates(1, {22}, 2s, 2);
    EXPECT_THAT(States(), ElementsAre(0, 22));
}

class BeatPeriodTest : public PeerTableTest
{
protected:
    void HearMeaning(std::uint16_t next, Ns at)
    {
        HeardBeat heard = BeatOf("uav1", 5, at);
        heard.Beat.next_ms = next;
        table.OnBeat(heard);
    }

    NodeState StateAt(Ns now)
    {
        table.Advance(now);
        return StateOf("uav1");
    }
};

TEST_F(BeatPeriodTest, ANodeIsJudgedByWhenItsNextBeatIsDue)
{
    HearMeaning(5000, 1s);
    EXPECT_EQ(StateAt(16s), NodeState::UP);
    EXPECT_EQ(StateAt(16s + 1ns), NodeState::STALE);
    EXPECT_EQ(table.Find("uav1")->Reason, "no beat within its limit of 15 s");
    EXPECT_EQ(StateAt(36s), NodeState::STALE);
    EXPECT_EQ(StateAt(36s + 1ns), NodeState::LOST);
    EXPECT_EQ(table.Find("uav1")->Reason, "no beat within its limit of 35 s");
}

TEST_F(BeatPeriodTest, WhatTheNewestBeatSaysHolds)
{
    HearMeaning(5000, 1s);
    HearMeaning(500, 2s);
    EXPECT_EQ(StateAt(3500ms), NodeState::UP);
    EXPECT_EQ(StateAt(3501ms), NodeState::STALE);
}

TEST_F(BeatPeriodTest, ANodeThatSaysNoneOrNonsenseIsJudgedByTheNearestPossible)
{
    HearMeaning(0, 1s);
    EXPECT_EQ(StateAt(1300ms), NodeState::UP);
    EXPECT_EQ(StateAt(1301ms), NodeState::STALE);
    HearMeaning(65535, 2s);
    EXPECT_EQ(StateAt(182s), NodeState::UP);
    EXPECT_EQ(StateAt(182s + 1ns), NodeState::STALE);
}

TEST_F(PeerTableTest, NamesFromTheNetworkCannotFillTheMemory)
{
    for (std::size_t i = 0; i < 2 * PeerTable::MaximumPeers; ++i)
    {
        Hear(std::string("node").append(std::to_string(i)), 1, 1s + Ns(i));
    }
    EXPECT_EQ(table.Heard().size(), PeerTable::MaximumPeers);
    table.Advance(60s);
    Hear("late", 1, 60s);
    EXPECT_EQ(table.Heard().size(), PeerTable::MaximumPeers);
    EXPECT_EQ(StateOf("late"), NodeState::UP);
}

}  // namespace
}  // namespace Rabit
