// Which announcements and numbers of a peer are accepted, given its earlier ones.
#include "guard/KnownPeers.h"

#include <gtest/gtest.h>

#include "guard/DeliveryCheck.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using namespace std::chrono_literals;
using Rabit::Rtps::KnownPeers;

class KnownPeersTest : public testing::Test
{
protected:
    KnownPeersTest()
    {
        Peers.Announced(Sender, 1, Now);
        Peers.EndpointAnnounced(Sender, UserWriter, 1);
    }

    static GuidPrefix Stranger(int number)
    {
        GuidPrefix prefix = Other;
        prefix[0] = static_cast<std::uint8_t>(number);
        prefix[1] = static_cast<std::uint8_t>(number >> 8);
        prefix[2] = 77;
        return prefix;
    }

    KnownPeers Peers;
    KnownPeers::TimePoint Now{1h};
};

TEST_F(KnownPeersTest, OnlyAnnouncedPeersAreHeard)
{
    EXPECT_TRUE(Peers.Hears(Sender, Now));
    EXPECT_FALSE(Peers.Hears(Other, Now));
}

TEST_F(KnownPeersTest, TheGroupReachesAHostWhileAListenerThereIsHeard)
{
    const Rabit::Rtps::HostAddress host{10, 0, 0, 2};
    Peers.IsAt(Sender, std::span(&host, 1), host);
    Peers.SetListensToGroup(Sender, true);
    Peers.Hears(Sender, Now + 1s);
    EXPECT_TRUE(Peers.GroupReaches(host, Now + 1s));
    EXPECT_FALSE(Peers.GroupReaches(host, Now + 2s));
    EXPECT_FALSE(Peers.GroupReaches({10, 0, 0, 3}, Now));
}

TEST_F(KnownPeersTest, TheGroupDoesNotReachAHostOfWhichOneParticipantDoesNotListenToIt)
{
    const Rabit::Rtps::HostAddress host{10, 0, 0, 2};
    Peers.IsAt(Sender, std::span(&host, 1), host);
    Peers.SetListensToGroup(Sender, true);
    ASSERT_TRUE(Peers.GroupReaches(host, Now));
    Peers.Announced(Other, 1, Now);
    Peers.IsAt(Other, std::span(&host, 1), host);
    EXPECT_FALSE(Peers.GroupReaches(host, Now));
}

TEST_F(KnownPeersTest, APeerDoesNotMoveElsewhereWhileItIsHeard)
{
    EXPECT_TRUE(Peers.Announced(Sender, 1, Now + 59s));
    EXPECT_FALSE(Peers.Announced(Sender, 2, Now + 118s));
    EXPECT_TRUE(Peers.Announced(Sender, 2, Now + 120s));
    EXPECT_FALSE(Peers.Announced(Sender, 1, Now + 121s));
}

// A laptop that moves to another WiFi: its other traffic is heard all the time.
TEST_F(KnownPeersTest, APeerThatMovesIsBelievedWhenItsFormerPlaceIsHeardNoMore)
{
    for (int i = 0; i < 3; ++i)
    {
        Now += 3s;
        EXPECT_TRUE(Peers.Announced(Sender, 1, Now));
    }
    for (int i = 0; i < 2; ++i)
    {
        Now += 3s;
        EXPECT_TRUE(Peers.Hears(Sender, Now));
        EXPECT_FALSE(Peers.Announced(Sender, 2, Now)) << i;
    }
    Now += 3s;
    EXPECT_TRUE(Peers.Announced(Sender, 2, Now));
    Now += 3s;
    EXPECT_TRUE(Peers.Announced(Sender, 2, Now));
    EXPECT_FALSE(Peers.Announced(Sender, 1, Now));
}

TEST_F(KnownPeersTest, AForgedPlaceIsNotBelievedHoweverOftenItIsSaidBetweenTheTrueOnes)
{
    for (int i = 0; i < 10; ++i)
    {
        Now += 3s;
        EXPECT_TRUE(Peers.Announced(Sender, 1, Now));
        for (const auto later : {1s, 3s, 5s})  // one of the true ones is lost
        {
            for (int times = 0; times < 100; ++times)
            {
                ASSERT_FALSE(Peers.Announced(Sender, 2, Now + later));
            }
        }
        Now += 3s;
    }
}

TEST_F(KnownPeersTest, RepeatsOfTheTruePlaceDoNotHelpAForgedOne)
{
    Now += 10s;
    EXPECT_TRUE(Peers.Announced(Sender, 1, Now));
    EXPECT_TRUE(Peers.Announced(Sender, 1, Now + 1ms));
    for (int times = 0; times < 100; ++times)
    {
        ASSERT_FALSE(Peers.Announced(Sender, 2, Now + 9s));
    }
}

TEST_F(KnownPeersTest, APeerThatWasAwayMayMoveWithinHalfAMinute)
{
    Now += 59s;
    EXPECT_TRUE(Peers.Announced(Sender, 1, Now));
    for (int i = 0; i < 10; ++i)
    {
        Now += 3s;
        EXPECT_TRUE(Peers.Hears(Sender, Now));
        EXPECT_EQ(Peers.Announced(Sender, 2, Now), i == 9) << i;
    }
}

TEST_F(KnownPeersTest, OnePlaceThatWasForgedIsNotBelievedForLong)
{
    EXPECT_TRUE(Peers.Announced(Other, 666, Now));
    for (int i = 0; i < 2; ++i)
    {
        Now += 1s;
        EXPECT_TRUE(Peers.Hears(Other, Now));
        EXPECT_FALSE(Peers.Announced(Other, 1, Now)) << i;
    }
    Now += 1s;
    EXPECT_TRUE(Peers.Announced(Other, 1, Now));
}

TEST_F(KnownPeersTest, APeerThatIsSaidToBeHereAndThereDoesNotMove)
{
    for (std::uint64_t place = 2; place < 100; ++place)
    {
        Now += 1s;
        EXPECT_TRUE(Peers.Hears(Sender, Now));
        EXPECT_FALSE(Peers.Announced(Sender, place, Now)) << place;
        EXPECT_FALSE(Peers.Announced(Sender, place, Now)) << place;
    }
}

// A refused announcement counts as not received, so its writer retransmits it until it is accepted.
TEST_F(KnownPeersTest, AnEndpointThatChangesIsBelievedWithItsThirdAnnouncementInARow)
{
    for (const EntityId endpoint : {0x00000203u, UserReader})
    {
        for (std::uint64_t digest = 7; digest < 10; ++digest)
        {
            for (int repeat = 1; repeat <= 2; ++repeat)
            {
                EXPECT_EQ(Peers.EndpointAnnounced(Sender, endpoint, digest), digest == 7) << repeat;
            }
            EXPECT_TRUE(Peers.EndpointAnnounced(Sender, endpoint, digest));
            EXPECT_TRUE(Peers.EndpointAnnounced(Sender, endpoint, digest));
            EXPECT_FALSE(Peers.EndpointAnnounced(Sender, endpoint, digest - 1)) << "as it was";
        }
    }
}

TEST_F(KnownPeersTest, AnEndpointDoesNotChangeWhileItIsAnnouncedAsItWas)
{
    for (const EntityId endpoint : {0x00000203u, UserReader})
    {
        for (int i = 0; i < 100; ++i)
        {
            EXPECT_TRUE(Peers.EndpointAnnounced(Sender, endpoint, 7));
            EXPECT_FALSE(Peers.EndpointAnnounced(Sender, endpoint, 8));
            EXPECT_FALSE(Peers.EndpointAnnounced(Sender, endpoint, 8));
        }
    }
}

TEST_F(KnownPeersTest, AnEndpointDoesNotChangeToThisAndThat)
{
    for (const EntityId endpoint : {0x00000203u, UserReader})
    {
        EXPECT_TRUE(Peers.EndpointAnnounced(Sender, endpoint, 7));
        for (std::uint64_t digest = 8; digest < 100; ++digest)
        {
            EXPECT_FALSE(Peers.EndpointAnnounced(Sender, endpoint, digest));
            EXPECT_FALSE(Peers.EndpointAnnounced(Sender, endpoint, digest));
        }
    }
}

TEST_F(KnownPeersTest, TheFirstNumberOfAWriterMayBeAnyUpToWhereTheVendorCanWalk)
{
    constexpr std::int64_t Largest = 1 << 22;
    EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, Largest + 1, Now));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, Largest, Now));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, Largest + 1, Now));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 3, Now));
}

// The writer may have written for months. A forged number of this size would hold a thread of the vendor
// for hours.
TEST_F(KnownPeersTest, AGreaterFirstNumberIsBelievedWhenEightInARowAgree)
{
    constexpr std::int64_t Large = std::int64_t{1} << 36;
    for (int i = 0; i < 7; ++i)
    {
        EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, Large + i, Now));
    }
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, Large + 7, Now));
}

TEST_F(KnownPeersTest, NumbersDoNotJump)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10, Now));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 26, Now));
    EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 43, Now));
    // A refused number does not count as an advance.
    EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 43, Now));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 42, Now));
}

// A node writes the samples of all its links by one best-effort writer, each to one other node.
TEST_F(KnownPeersTest, ABestEffortWriterMayHaveWrittenMostOfItsSamplesToOthers)
{
    constexpr EntityId Writer = 0x00000303u;
    EXPECT_TRUE(Peers.EndpointAnnounced(Sender, Writer, 7, true));
    EXPECT_TRUE(Peers.Reaches(Sender, Writer, 10, Now));
    EXPECT_TRUE(Peers.Reaches(Sender, Writer, 10'000, Now + 100ms));
    EXPECT_FALSE(Peers.Reaches(Sender, Writer, std::int64_t{1} << 36, Now + 100ms));
}

// Multicast still arrives while all samples are lost, so the peer is not silent. Two beats a second are
// accepted at once, without eight of them that agree.
TEST_F(KnownPeersTest, AWriterThatWasNotHeardForAWhileGoesOnWhereItIs)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10, Now));
    for (int second = 1; second <= 5; ++second)
    {
        EXPECT_TRUE(Peers.Hears(Sender, Now + std::chrono::seconds(second)));
    }
    EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 10 + 16 + 5001, Now + 5s));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10 + 16 + 5000, Now + 5s));
}

// At two beats a second, the time since the last one does not allow for a thousand samples. After a forged
// number, the honest ones would be ignored until they reach it.
TEST_F(KnownPeersTest, AWriterThatIsHeardDoesNotJump)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10, Now));
    for (int beat = 1; beat <= 20; ++beat)
    {
        Now += 500ms;
        EXPECT_TRUE(Peers.Hears(Sender, Now));
        EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 500 + 100 * beat, Now)) << beat;
        EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10 + beat, Now)) << beat;
    }
}

TEST_F(KnownPeersTest, AWriterThatIsHeardBehindAForgedNumberDoesNotJumpEither)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10, Now));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 26, Now));
    for (int beat = 1; beat <= 16; ++beat)
    {
        Now += 500ms;
        EXPECT_TRUE(Peers.Hears(Sender, Now));
        EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10 + beat, Now)) << beat;
        EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 500, Now)) << beat;
    }
}

TEST_F(KnownPeersTest, ForgedStepsDoNotMakeAFasterWriter)
{
    std::int64_t number = 10;
    for (int step = 0; step < 10; ++step)
    {
        EXPECT_TRUE(Peers.Hears(Sender, Now));
        EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, number, Now)) << step;
        number += 16;
        Now += 500ms;
    }
    EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, number + 10, Now));
}

TEST_F(KnownPeersTest, NoSilenceOfAWriterMakesAGapThatIsTooLargeToNote)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10, Now));
    for (int second = 1; second <= 3600; ++second)
    {
        EXPECT_TRUE(Peers.Hears(Sender, Now + std::chrono::seconds(second)));
    }
    EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 10 + 16 + 50'001, Now + 1h));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10 + 16 + 50'000, Now + 1h));
}

TEST_F(KnownPeersTest, AFastWriterMayBeFartherTheLongerNothingWasHeardOfIt)
{
    for (int i = 0; i <= 2000; ++i)
    {
        ASSERT_TRUE(Peers.Hears(Sender, Now));
        ASSERT_TRUE(Peers.Reaches(Sender, UserWriter, 1 + i, Now));
        Now += 1ms;
    }
    // The writer made 1000 samples a second; twice that distance is accepted.
    Now += 499ms;
    EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 2001 + 1017, Now));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 2001 + 1016, Now));
}

TEST_F(KnownPeersTest, AFastWriterIsWhereItsPaceHasTakenItWhileItWasNotHeard)
{
    EntityId writer = UserWriter;
    for (const int perSecond : {100, 1000, 5000})
    {
        for (const auto silence : {25s, 60s, 600s})
        {
            writer += 0x100;
            Peers.EndpointAnnounced(Sender, writer, 1);
            std::int64_t number = 0;
            for (; number < 3 * perSecond; ++number)
            {
                Now += 1'000'000us / perSecond;
                ASSERT_TRUE(Peers.Reaches(Sender, writer, number + 1, Now));
            }
            Now += silence;
            EXPECT_TRUE(Peers.Reaches(Sender, writer, number + perSecond * silence.count(), Now))
                << perSecond << " a second, after " << silence.count() << " s";
        }
    }
}

// The writer became fast as the network went, so its rate is unknown.
TEST_F(KnownPeersTest, AWriterThatBecameFastWhileItWasNotHeardIsBelievedWithItsEighth)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 10, Now));
    Now += 60s;
    for (std::int64_t i = 1; i < 8; ++i)
    {
        EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 300'000 + i, Now)) << i;
    }
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 300'008, Now));
}

TEST_F(KnownPeersTest, AJumpIsBelievedWhenEightInARowAgree)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 1, Now));
    for (std::int64_t number = 5001; number <= 5007; ++number)
    {
        EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, number, Now)) << number;
    }
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 5008, Now));
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 5009, Now));
}

TEST_F(KnownPeersTest, AHeartbeatThatRepeatsItsNumberAgrees)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 1, Now));
    for (int i = 0; i < 7; ++i)
    {
        EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 5000, Now));
    }
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 5000, Now));
}

TEST_F(KnownPeersTest, AJumpIsNotBelievedWhileTheWriterGoesOnFromWhereItWas)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 1, Now));
    for (int i = 0; i < 100; ++i)
    {
        EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 5000, Now)) << i;
        if (i % 7 == 6)
        {
            EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 2 + i / 7, Now));
        }
    }
}

TEST_F(KnownPeersTest, JumpsToHereAndThereAreNotBelieved)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 1, Now));
    for (int i = 0; i < 100; ++i)
    {
        EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 5000 + 17 * i, Now)) << i;
        EXPECT_FALSE(Peers.Reaches(Sender, UserWriter, 4000, Now)) << i;
    }
}

TEST_F(KnownPeersTest, AWriterThatWasNotAnnouncedReachesNothing)
{
    EXPECT_FALSE(Peers.HasWriter(Sender, 0x00000203));
    EXPECT_FALSE(Peers.Reaches(Sender, 0x00000203, 1, Now));
    EXPECT_TRUE(Peers.HasWriter(Sender, Rabit::Rtps::PublicationsWriter));
}

TEST_F(KnownPeersTest, EndpointsThatAreGoneMayComeBackOtherwise)
{
    constexpr EntityId reader = 0x00000204;
    EXPECT_TRUE(Peers.EndpointAnnounced(Sender, reader, 7));
    EXPECT_FALSE(Peers.EndpointAnnounced(Sender, reader, 8));
    Peers.EndpointGone(Sender, reader);
    EXPECT_TRUE(Peers.EndpointAnnounced(Sender, reader, 8));
    Peers.EndpointGone(Sender, UserWriter);
    EXPECT_FALSE(Peers.HasWriter(Sender, UserWriter));
    EXPECT_TRUE(Peers.EndpointAnnounced(Sender, UserWriter, 8));
    Peers.EndpointsGone(Sender);
    EXPECT_FALSE(Peers.HasWriter(Sender, UserWriter));
    EXPECT_TRUE(Peers.HasWriter(Sender, Rabit::Rtps::PublicationsWriter));
}

TEST_F(KnownPeersTest, NobodyKnowsOfSamplesFarAhead)
{
    EXPECT_TRUE(Peers.Reaches(Sender, UserWriter, 1000, Now));
    EXPECT_TRUE(Peers.CanKnowOf(Sender, UserWriter, 1016));
    EXPECT_FALSE(Peers.CanKnowOf(Sender, UserWriter, 1017));
    EXPECT_FALSE(Peers.CanKnowOf(Sender, 0x00000203, 1));
}

TEST_F(KnownPeersTest, AnnouncementsKeepTheirNumbersUntilThePeerMoves)
{
    EXPECT_EQ(Peers.AnnouncementOf(Sender, 5), 5);
    EXPECT_EQ(Peers.AnnouncementOf(Sender, 5), 5);
    EXPECT_EQ(Peers.AnnouncementOf(Sender, 6), 6);
    EXPECT_EQ(Peers.AnnouncementOf(Sender, 5), 6) << "a straggler is no news";
    EXPECT_TRUE(Peers.Announced(Sender, 2, Now + 60s));
    EXPECT_EQ(Peers.AnnouncementOf(Sender, 1), 7);
    EXPECT_EQ(Peers.AnnouncementOf(Sender, 1), 7);
    EXPECT_EQ(Peers.AnnouncementOf(Sender, 2), 8);
}

TEST_F(KnownPeersTest, NumbersOfAnnouncementsDoNotFallWhenThePeerWasForgotten)
{
    EXPECT_EQ(Peers.AnnouncementOf(Sender, 100), 100);
    Now += 61s;
    for (int i = 0; i < 1024; ++i)
    {
        Peers.Announced(Stranger(i), 1, Now);
    }
    ASSERT_FALSE(Peers.Hears(Sender, Now));
    Now += 61s;
    EXPECT_TRUE(Peers.Announced(Sender, 1, Now));
    EXPECT_EQ(Peers.AnnouncementOf(Sender, 1), 101);
}

TEST_F(KnownPeersTest, CountsRiseByOneWhateverThePeerCounts)
{
    const auto first = Peers.CountOf(Sender, UserWriter, 7);
    EXPECT_GT(first, 0u);  // the vendor begins at 0
    EXPECT_EQ(Peers.CountOf(Sender, UserWriter, 8), first + 1);
    EXPECT_EQ(Peers.CountOf(Sender, UserWriter, 0xffffffff), first + 2);
    EXPECT_EQ(Peers.CountOf(Sender, UserWriter, 9), first + 3);
}

TEST_F(KnownPeersTest, ARepeatKeepsItsCount)
{
    const auto first = Peers.CountOf(Sender, UserWriter, 7);
    EXPECT_EQ(Peers.CountOf(Sender, UserWriter, 7), first);
}

TEST_F(KnownPeersTest, CountsDoNotFallWhenTheWriterComesBack)
{
    std::uint32_t last = 0;
    for (std::uint32_t i = 0; i < 1000; ++i)
    {
        last = Peers.CountOf(Sender, UserWriter, i);
    }
    Peers.EndpointGone(Sender, UserWriter);
    ASSERT_FALSE(Peers.HasWriter(Sender, UserWriter));
    Peers.EndpointAnnounced(Sender, UserWriter, 1);
    EXPECT_GT(Peers.CountOf(Sender, UserWriter, 1), last);
}

TEST_F(KnownPeersTest, StrangersPushNobodyOutWhoIsHeard)
{
    for (int i = 0; i < 5000; ++i)
    {
        Peers.Announced(Stranger(i), 1, Now);
    }
    EXPECT_EQ(Peers.Size(), 1024u);
    EXPECT_TRUE(Peers.Hears(Sender, Now));
    EXPECT_FALSE(Peers.Announced(Stranger(6000), 1, Now + 59s));
    // Peers that fell silent make room; the others remain.
    EXPECT_TRUE(Peers.Hears(Sender, Now + 61s));
    EXPECT_TRUE(Peers.Announced(Stranger(6000), 1, Now + 61s));
    EXPECT_TRUE(Peers.Hears(Sender, Now + 61s));
    EXPECT_EQ(Peers.Size(), 1024u);
}

TEST_F(KnownPeersTest, ThoseWhoComeAndGoAreForgottenAfterFiveMinutes)
{
    for (int i = 0; i < 600; ++i)
    {
        const auto now = Now + i * 10s;
        EXPECT_TRUE(Peers.Hears(Sender, now));
        EXPECT_TRUE(Peers.Announced(Stranger(i), 1, now));
        EXPECT_LE(Peers.Size(), 70u) << "of 30 in five minutes, twice";
    }
    EXPECT_TRUE(Peers.Hears(Stranger(570), Now + 6000s)) << "silent for 300 s";
}

}  // namespace
