// How fast sessions are introduced to each other, and what that costs.
#include <gtest/gtest.h>

#include "envelope/SealedFleet.h"

namespace
{

using namespace SealedFleets;

constexpr Medium Megabit{.BitsPerSecond = 1e6};
constexpr double SlowRadio = 250e3;

TEST(SealedMeeting, TenNodesThatStartAtOnceAreOpenToEachOtherWithin3Seconds)
{
    const auto fleet = FleetOf(10, Megabit);
    fleet->StartAll();
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 10s), 3s);
    fleet->Run(3s);
    EXPECT_LE(fleet->OwnBytes, 80'000u);
}

TEST(SealedMeeting, TenNodesThatStartOneAfterTheOtherAreOpenToEachOtherWithin3Seconds)
{
    const auto fleet = FleetOf(10, Megabit);
    for (std::size_t index = 0; index < 10; ++index)
    {
        fleet->StartNode(index);
        fleet->Run(150ms);
    }
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 10s), 3s);
    fleet->Run(3s);
    EXPECT_LE(fleet->OwnBytes, 80'000u);
}

TEST(SealedMeeting, ElevenNodesThatStartAtOnceDoNotFillASlowRadio)
{
    const auto fleet = FleetOf(11, {.BitsPerSecond = SlowRadio});
    fleet->StartAll();
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 20s), 4s);
    fleet->Run(3s);
    EXPECT_LE(fleet->OwnBytes, 60'000u);
}

TEST(SealedMeeting, ElevenNodesMeetOnASlowRadioThatTheirTrafficFillsByTwoThirds)
{
    const auto fleet = FleetOf(11, {.BitsPerSecond = SlowRadio, .Beat = 100ms});
    fleet->StartAll();
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 20s), 5s);
    fleet->Run(3s);
    EXPECT_LE(fleet->OwnBytes, 80'000u);
}

// The others ask it all the time, and it never answers.
TEST(SealedMeeting, ANodeThatHearsNobodyDoesNotKeepTheOthersFromMeeting)
{
    const auto fleet = FleetOf(11, {.BitsPerSecond = SlowRadio});
    fleet->Hears = [](std::size_t, std::size_t to) { return to != 10; };
    fleet->StartAll();
    const auto areOthersOpen = [&]
    {
        for (std::size_t to = 0; to < 10; ++to)
        {
            for (std::size_t from = 0; from < 10; ++from)
            {
                if (to != from && !fleet->IsOpen(to, from))
                {
                    return false;
                }
            }
        }
        return true;
    };
    EXPECT_LE(fleet->RunUntil(areOthersOpen, 20s), 5s);
}

TEST(SealedMeeting, ElevenNodesMeetWhereEachHasTurnsForFiveHundredBytesASecond)
{
    const auto fleet = FleetOf(11, {.BitsPerSecond = SlowRadio, .Turns = 500.0});
    fleet->StartAll();
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 60s), 15s);
    EXPECT_LE(fleet->OwnBytes, 80'000u);
}

// With a budget, each datagram is given the turn for its size.
TEST(SealedMeeting, IntroductionsHaveTheSizeThatTheySayBefore)
{
    const auto fleet = FleetOf(4, {.Loss = 0.2});
    fleet->StartAll();
    fleet->Run(5s);
    fleet->Nodes[0]->Keys->Learn(fleet->BulletinOf(2, {1, 2, 3, 4}));
    fleet->StartNode(3);
    fleet->Run(5s);
    EXPECT_GT(fleet->OwnBytes, 0u);
    EXPECT_EQ(fleet->Misjudged, 0u);
}

TEST(SealedMeeting, NodesThatKnowEachOtherSayNothing)
{
    const auto fleet = FleetOf(4);
    fleet->StartAll();
    fleet->Run(20s);
    ASSERT_TRUE(fleet->AreAllOpen());
    const std::size_t before = fleet->OwnBytes;
    fleet->Run(60s);
    EXPECT_EQ(fleet->OwnBytes, before);
    EXPECT_TRUE(fleet->AreAllOpen());
}

// Returns the longest time of a hundred seeds.
Duration WorstOfAHundred(double loss)
{
    Duration worst{0};
    for (std::uint64_t seed = 1; seed <= 100; ++seed)
    {
        const auto fleet = FleetOf(2, {.Loss = loss, .Seed = seed});
        fleet->StartAll();
        worst = std::max(worst, fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 20s));
    }
    return worst;
}

TEST(SealedMeeting, TwoNodesMeetWhereAFifthOfTheDatagramsIsLost)
{
    EXPECT_LE(WorstOfAHundred(0.2), 1500ms);
}

TEST(SealedMeeting, TwoNodesMeetWhereTwoFifthsOfTheDatagramsAreLost)
{
    EXPECT_LE(WorstOfAHundred(0.4), 4s);
}

TEST(SealedMeeting, DatagramsThatComeTwiceAndInAnotherOrderDoNoHarm)
{
    const auto fleet = FleetOf(4, {.Loss = 0.1, .Copies = 0.5});
    fleet->StartAll();
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 10s), 3s);
}

TEST(SealedMeeting, NodesAreFreshAgainWithinASecondAfterACut)
{
    const auto fleet = FleetOf(3, {.Beat = 200ms});
    fleet->StartAll();
    fleet->Run(5s);
    ASSERT_TRUE(fleet->AreAllOpen());
    fleet->Hears = [](std::size_t from, std::size_t to) { return (from < 2) == (to < 2); };
    fleet->Run(15s);
    ASSERT_FALSE(fleet->IsOpen(0, 2));
    ASSERT_TRUE(fleet->IsOpen(0, 1));
    fleet->Hears = [](std::size_t, std::size_t) { return true; };
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 10s), 1s);
}

TEST(SealedMeeting, ANodeThatStartsAnewIsOpenWithinASecond)
{
    const auto fleet = FleetOf(3, {.Beat = 200ms});
    fleet->StartAll();
    fleet->Run(5s);
    fleet->StartNode(1);
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 10s), 1s);
    // The others listen to the new session.
    EXPECT_EQ(fleet->Nodes[0]->Core->PeerOf(fleet->PrefixOfNode(1))->Name, "uav2");
}

TEST(SealedMeeting, ALinkThatIsOpenOneWayOpensNothing)
{
    const auto fleet = FleetOf(2);
    fleet->Hears = [](std::size_t from, std::size_t) { return from == 0; };
    fleet->StartAll();
    fleet->Run(20s);
    EXPECT_FALSE(fleet->IsOpen(1, 0));
    EXPECT_FALSE(fleet->IsOpen(0, 1));
}

TEST(SealedMeeting, NothingComesOutBeforeTheListOfPermissionsIsThere)
{
    const auto fleet = FleetOf(2);
    fleet->StartAll();
    std::size_t early = 0;
    fleet->RunUntil(
        [&]
        {
            early +=
                fleet->Nodes[0]->Heard.contains(1) && !fleet->Nodes[0]->Core->PeerOf(fleet->PrefixOfNode(1))
                    ? 1
                    : 0;
            return fleet->Nodes[0]->Heard.contains(1);
        },
        10s);
    EXPECT_TRUE(fleet->Nodes[0]->Heard.contains(1));
    EXPECT_EQ(early, 0u);
    const auto peer = fleet->Nodes[0]->Core->PeerOf(fleet->PrefixOfNode(1));
    ASSERT_TRUE(peer);
    EXPECT_TRUE(peer->List->MayRead("fleet/node2/topic3"));
    EXPECT_FALSE(peer->List->MayRead("fleet/node1/topic3"));
}

TEST(SealedMeeting, AWrongClockIsAWarningAlone)
{
    const auto fleet = FleetOf(2);
    fleet->Nodes[0]->Utc = 0;
    fleet->Nodes[1]->Utc = 4'000'000'000;
    fleet->StartAll();
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 10s), 1s);
    const auto early = fleet->Nodes[0]->Keys->Problems();
    ASSERT_EQ(early.size(), 2u);
    EXPECT_EQ(early[0].Text, "the certificate of uav1 begins on 2023-11-14: check this host's clock");
    EXPECT_EQ(early[1].Entry, "uav2");
    const auto late = fleet->Nodes[1]->Keys->Problems();
    ASSERT_EQ(late.size(), 2u);
    EXPECT_EQ(late[0].Text, "the certificate of uav2 ended on 2033-05-18: make a new one");
}

TEST(SealedMeeting, AToolMayWriteNothing)
{
    SealedFleet fleet;
    const Bytes first = fleet.BulletinOf(1, {1, 2});
    fleet.Add("uav1", 1, {first});
    fleet.Add("laptop", 2, {first}, CertificateRole::Tool);
    fleet.StartAll();
    ASSERT_LE(fleet.RunUntil([&] { return fleet.AreAllOpen(); }, 10s), 1s);
    const auto tool = fleet.Nodes[0]->Core->PeerOf(fleet.PrefixOfNode(1));
    EXPECT_FALSE(tool->List->MayWrite("fleet/node2/topic1", tool->Role));
    EXPECT_TRUE(tool->List->MayRead("fleet/node2/topic1"));
}

}  // namespace
