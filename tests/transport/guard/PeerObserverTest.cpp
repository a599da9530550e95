// The guard reports participants to its observer, and leaves those with cards to it.
#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <vector>

#include "common/ParticipantIdentity.h"
#include "guard/RtpsBytes.h"
#include "guard/RtpsGuard.h"

namespace
{

using namespace RtpsBytes;
using Rabit::Rtps::PeerObserver;
using Rabit::Rtps::RtpsGuard;

class Observer : public PeerObserver
{
public:
    void HeardUnknown(const GuidPrefix &peer) override { Unknown.push_back(peer); }
    void Announced(const GuidPrefix &peer, bool hasCard) override { Heard.emplace_back(peer, hasCard); }
    void Gone(const GuidPrefix &peer) override { Left.push_back(peer); }
    void Spoke(const GuidPrefix &peer) override { Spoken.push_back(peer); }
    bool IsReplayed(const GuidPrefix &) const override { return Replays; }

    std::vector<GuidPrefix> Unknown;
    std::vector<std::pair<GuidPrefix, bool>> Heard;
    std::vector<GuidPrefix> Left;
    std::vector<GuidPrefix> Spoken;
    bool Replays = false;
};

class PeerObserverTest : public testing::Test
{
protected:
    PeerObserverTest() { Guard.SetObserver(Seen); }

    // Returns the number of messages that the vendor is given.
    std::size_t Admit(Bytes datagram, RtpsGuard::Origin origin = RtpsGuard::Origin::Network)
    {
        std::size_t handed = 0;
        EXPECT_TRUE(Guard.Admit(
            datagram, SenderHost, Now,
            [&](std::span<std::uint8_t> message)
            {
                ++handed;
                Handed.assign(message.begin(), message.end());
            },
            origin));
        return handed;
    }
    static Bytes AnnouncementWithCard(std::uint32_t lease = 30, std::int64_t number = 1)
    {
        const std::string text = Rabit::MakeUserData(7, true);
        Bytes data = Join({U32(static_cast<std::uint32_t>(text.size())), Bytes(text.begin(), text.end())});
        data.resize((data.size() + 3) / 4 * 4);
        const Bytes guid = Parameter(0x0050, Guid(Sender, Rabit::Rtps::ParticipantEntity));
        const Bytes list =
            List({guid, Parameter(0x0002, Join({U32(lease), U32(0)})), Parameter(0x002c, data)});
        return Message(Data, DataBody(number, list, Rabit::Rtps::ParticipantWriter), 0x05);
    }
    static Bytes Goodbye(std::int64_t number)
    {
        const Bytes key = Parameter(0x0070, Guid(Sender, Rabit::Rtps::ParticipantEntity));
        const Bytes status = Parameter(0x0071, {0, 0, 0, 3});
        return Message(
            Data, DataBody(number, Join({key, status, {1, 0, 0, 0}}), Rabit::Rtps::ParticipantWriter), 0x03);
    }

    RtpsGuard::TimePoint Now{std::chrono::hours(1)};
    Bytes Handed;  // the last message that the vendor was given
    Observer Seen;
    RtpsGuard Guard{RtpsGuard::Mode::Full, std::chrono::seconds(10)};
};

TEST_F(PeerObserverTest, AnAnnouncementOfAProgramIsHandedOn)
{
    EXPECT_EQ(Admit(ParticipantMessage()), 1u);
    ASSERT_EQ(Seen.Heard.size(), 1u);
    EXPECT_EQ(Seen.Heard[0], std::pair(Sender, false));
}

TEST_F(PeerObserverTest, AnAnnouncementOfAParticipantWithACardIsLeftToTheObserver)
{
    EXPECT_EQ(Admit(AnnouncementWithCard()), 0u);
    ASSERT_EQ(Seen.Heard.size(), 1u);
    EXPECT_EQ(Seen.Heard[0], std::pair(Sender, true));
}

TEST_F(PeerObserverTest, WhatACardSaysIsHandedOn)
{
    EXPECT_EQ(Admit(AnnouncementWithCard(), RtpsGuard::Origin::Card), 1u);
    EXPECT_TRUE(Seen.Heard.empty());
}

// The reader of the card has put it there: it remembers silent nodes for hours.
TEST_F(PeerObserverTest, TheLeaseInACardIsNotCut)
{
    const Bytes announcement = AnnouncementWithCard(4 * 3600);
    EXPECT_EQ(Admit(announcement, RtpsGuard::Origin::Card), 1u);
    EXPECT_EQ(Handed, announcement);
}

TEST_F(PeerObserverTest, AParticipantWithACardIsNotAnnouncedWithoutOne)
{
    ASSERT_EQ(Admit(AnnouncementWithCard(), RtpsGuard::Origin::Card), 1u);
    Seen.Replays = true;
    std::size_t handed = 0;
    for (int i = 0; i < 100; ++i)
    {
        Now += std::chrono::seconds(1);
        Bytes plain = ParticipantMessage();
        EXPECT_FALSE(Guard.Admit(plain, SenderHost, Now, [&](auto) { ++handed; }));
    }
    EXPECT_EQ(handed, 0u);
    EXPECT_TRUE(Seen.Heard.empty());
}

// Somebody has announced it, with another address and without a card.
TEST_F(PeerObserverTest, ACardIsBelievedAfterItHasEndedAnAnnouncementWithoutOne)
{
    ASSERT_EQ(Admit(ParticipantMessage()), 1u);
    Bytes early = AnnouncementWithCard();
    EXPECT_FALSE(Guard.Admit(
        early, SenderHost, Now, [](auto) {}, RtpsGuard::Origin::Card));
    EXPECT_EQ(Admit(Goodbye(2), RtpsGuard::Origin::Card), 1u);
    EXPECT_EQ(Admit(AnnouncementWithCard(), RtpsGuard::Origin::Card), 1u);
}

TEST_F(PeerObserverTest, AnEndpointThatSpeaksIsToldOnce)
{
    ASSERT_EQ(Admit(ParticipantMessage()), 1u);
    ASSERT_EQ(
        Admit(Message(Data, DataBody(1, WriterData(UserWriter), Rabit::Rtps::PublicationsWriter), 0x05)), 1u);
    EXPECT_TRUE(Seen.Spoken.empty());
    for (std::int64_t number = 1; number <= 3; ++number)
    {
        EXPECT_EQ(Admit(Message(Data, DataBody(number), 0x05)), 1u);
    }
    EXPECT_EQ(Seen.Spoken, std::vector<GuidPrefix>{Sender});
}

// The numbers in a replay are not the participant's own.
TEST_F(PeerObserverTest, AGoodbyeIsNewsHoweverOftenTheCardWasReplayed)
{
    for (const std::int64_t number : {1, 2, 3})
    {
        EXPECT_EQ(Admit(AnnouncementWithCard(30, number), RtpsGuard::Origin::Card), 1u);
    }
    EXPECT_EQ(Admit(Goodbye(2)), 1u);
    EXPECT_EQ(Handed, Goodbye(4));
}

// The vendors go by the status alone.
TEST_F(PeerObserverTest, AGoodbyeThatCarriesTheWholeAnnouncementIsToldOf)
{
    Admit(AnnouncementWithCard(), RtpsGuard::Origin::Card);
    const Bytes status = Join({Parameter(0x0071, {0, 0, 0, 3}), {1, 0, 0, 0}});
    const Bytes list = List({Parameter(0x0050, Guid(Sender, Rabit::Rtps::ParticipantEntity)),
                             Parameter(0x0002, Join({U32(30), U32(0)}))});
    const Bytes goodbye = DataBody(1, Join({status, list}), Rabit::Rtps::ParticipantWriter);
    EXPECT_EQ(Admit(Message(Data, goodbye, 0x07)), 1u);
    EXPECT_EQ(Seen.Left, std::vector<GuidPrefix>{Sender});
}

TEST_F(PeerObserverTest, AnAnnouncementAfterAGoodbyeIsNews)
{
    Admit(AnnouncementWithCard(30, 3), RtpsGuard::Origin::Card);
    Admit(Goodbye(4));
    Now += Rabit::Rtps::RecentGoodbyes::Overtaken;
    EXPECT_EQ(Admit(AnnouncementWithCard(30, 1), RtpsGuard::Origin::Card), 1u);
    EXPECT_EQ(Handed, AnnouncementWithCard(30, 5));
}

TEST_F(PeerObserverTest, ADatagramOfAnUnknownParticipantIsToldOf)
{
    EXPECT_EQ(Admit(WriterMessage()), 0u);
    EXPECT_EQ(Seen.Unknown, std::vector{Sender});
}

TEST_F(PeerObserverTest, EndpointsThatAreReplayedAreNotTakenFromTheNetwork)
{
    Admit(AnnouncementWithCard(), RtpsGuard::Origin::Card);
    Seen.Replays = true;
    EXPECT_EQ(Admit(WriterMessage()), 0u);
    EXPECT_EQ(Admit(WriterMessage(), RtpsGuard::Origin::Card), 1u);
    EXPECT_TRUE(Seen.Unknown.empty());
}

TEST_F(PeerObserverTest, SomeoneHeardIsKnownToHaveBeen)
{
    EXPECT_FALSE(Guard.LastHeard(Sender).has_value());
    Admit(ParticipantMessage());
    EXPECT_EQ(Guard.LastHeard(Sender), RtpsGuard::TimePoint(std::chrono::hours(1)));
}

}  // namespace
