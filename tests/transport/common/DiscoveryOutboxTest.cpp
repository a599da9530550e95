// When what discovery has to say goes, and what goes together.
#include "common/DiscoveryOutbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "DiscoveryMessage.h"

namespace
{

using namespace std::chrono_literals;
using Rabit::DiscoveryOutbox;
using Message = DiscoveryMessage;
using Milliseconds = std::chrono::milliseconds;

constexpr std::uint64_t Group = 77;

class DiscoveryOutboxTest : public testing::Test
{
protected:
    struct Went
    {
        Milliseconds At{};
        std::uint64_t Address = 0;
        bool ToGroup = false;
        Message::Bytes Bytes;
    };

    void Put(const Message &message, Milliseconds at, std::uint64_t address = 1,
             std::optional<std::uint64_t> group = Group)
    {
        auto parts = Rabit::ReadDiscoveryParts(message.Datagram);
        ASSERT_TRUE(parts.has_value());
        for (auto &part : *parts)
        {
            Outbox.Put(message.Datagram, std::move(part), {.Address = address, .Group = group}, Start + at);
        }
    }
    // All that goes until then, as soon as it is due.
    std::vector<Went> Run(Milliseconds until)
    {
        std::vector<Went> went;
        while (const auto due = Outbox.Due())
        {
            if (*due > Start + until)
            {
                break;
            }
            const auto taken = Outbox.TakeDue(*due);
            EXPECT_FALSE(taken.empty());
            for (const auto &datagram : taken)
            {
                went.push_back({std::chrono::duration_cast<Milliseconds>(*due - Start), datagram.Address,
                                datagram.ToGroup, datagram.Bytes});
            }
        }
        return went;
    }
    // Puts the same each step; the times at which it went.
    std::vector<int> Repeat(const Message &message, int to, int step)
    {
        std::vector<int> times;
        for (int at = 0; at < to; at += step)
        {
            Put(message, Milliseconds(at));
            for (const Went &went : Run(Milliseconds(at + step - 1)))
            {
                times.push_back(static_cast<int>(went.At.count()));
            }
        }
        return times;
    }
    // That has all; to the participant of this test, whose header consists of one byte alone.
    static Message AnswerFrom(std::uint8_t peer, std::uint8_t to = 0x52)
    {
        Message answer;
        std::fill_n(answer.Datagram.begin() + 8, 12, peer);
        return answer.To(to).Acknowledge(6, 1);
    }
    // They know us.
    void Meet(std::uint8_t first, std::uint8_t last)
    {
        Outbox.Announced(Message().Datagram, Start - 1min);
        for (std::uint8_t peer = first; peer <= last; ++peer)
        {
            Outbox.Received(AnswerFrom(peer).Datagram, Start - 1min);
        }
    }
    // More than may go at once; that has gone.
    void PutMuch()
    {
        for (int number = 1; number <= 30; ++number)
        {
            Put(Message().News(static_cast<std::uint8_t>(number), 0, 500), 0ms);
        }
        Run(DiscoveryOutbox::Hold);
    }
    static double OnAir(const std::vector<Went> &all)
    {
        double bytes = 0.0;
        for (const Went &went : all)
        {
            bytes += static_cast<double>(went.Bytes.size() + DiscoveryOutbox::Headers);
        }
        return bytes;
    }

    DiscoveryOutbox Outbox;
    DiscoveryOutbox::TimePoint Start{1h};
};

TEST_F(DiscoveryOutboxTest, WhatIsNewGoesAfterTheHold)
{
    Put(Message().To(1).Beat(5, 1), 0ms, 4);
    const auto went = Run(1s);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_EQ(went[0].At, DiscoveryOutbox::Hold);
    EXPECT_EQ(went[0].Address, 4u);
    EXPECT_FALSE(went[0].ToGroup);
    EXPECT_EQ(went[0].Bytes, Message().To(1).Beat(5, 1).Datagram);
}

TEST_F(DiscoveryOutboxTest, WhatIsForSeveralWhoHearTheGroupGoesInOneDatagram)
{
    Put(Message().To(1).Beat(5, 1), 0ms, 1);
    Put(Message().To(2).Beat(5, 2), 0ms, 2);
    Put(Message().To(1).Acknowledge(5, 1), 5ms, 1);
    Put(Message().Beat(7, 3), 5ms, 3);
    const auto went = Run(100ms);
    ASSERT_EQ(went.size(), 2u);
    EXPECT_TRUE(went[0].ToGroup);
    EXPECT_EQ(went[0].Bytes, Message().To(1).Beat(5, 1).To(2).Beat(5, 2).Datagram);
    EXPECT_EQ(went[1].Bytes, Message().Beat(7, 3).To(1).Acknowledge(5, 1).Datagram);
}

TEST_F(DiscoveryOutboxTest, WhatIsForOneGoesToItsAddressTogether)
{
    Put(Message().To(1).Beat(5, 1), 0ms, 6);
    Put(Message().To(1).Acknowledge(5, 1), 0ms, 6);
    const auto went = Run(100ms);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_FALSE(went[0].ToGroup);
    EXPECT_EQ(went[0].Address, 6u);
    EXPECT_EQ(went[0].Bytes, Message().To(1).Beat(5, 1).Acknowledge(5, 1).Datagram);
}

TEST_F(DiscoveryOutboxTest, WhoDoesNotHearTheGroupHasItAlone)
{
    Put(Message().To(1).Beat(5, 1), 0ms, 1, std::nullopt);
    Put(Message().To(2).Beat(5, 1), 0ms, 2, std::nullopt);
    const auto went = Run(100ms);
    ASSERT_EQ(went.size(), 2u);
    EXPECT_FALSE(went[0].ToGroup || went[1].ToGroup);
    EXPECT_NE(went[0].Address, went[1].Address);
}

TEST_F(DiscoveryOutboxTest, GroupsAreNotMixed)
{
    Put(Message().Beat(5, 1), 0ms, 1, Group);
    Put(Message().Beat(5, 1), 0ms, 2, Group + 1);
    EXPECT_EQ(Run(100ms).size(), 2u);
}

TEST_F(DiscoveryOutboxTest, NewsForOneGoToAllWhoHearTheGroup)
{
    Put(Message().To(1).News(1, 4), 0ms, 1);
    Put(Message().To(2).News(1, 4), 0ms, 2);
    const auto went = Run(100ms);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_TRUE(went[0].ToGroup);
    EXPECT_EQ(went[0].Bytes, Message().News(1).Datagram);
}

TEST_F(DiscoveryOutboxTest, NewsKeepTheirReaderWhereThereIsNoGroup)
{
    Meet(1, 1);
    Put(Message().To(1).News(1, 4), 0ms, 1, std::nullopt);
    const auto went = Run(100ms);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_EQ(went[0].Bytes, Message().To(1).News(1, 4).Datagram);
}

TEST_F(DiscoveryOutboxTest, WhatIsNewerTakesThePlaceOfWhatHasNotGone)
{
    Put(Message().To(1).Acknowledge(5, 1), 0ms);
    Put(Message().To(1).Acknowledge(6, 2), 5ms);
    const auto went = Run(1s);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_EQ(went[0].At, DiscoveryOutbox::Hold);
    EXPECT_EQ(went[0].Bytes, Message().To(1).Acknowledge(6, 2).Datagram);
}

TEST_F(DiscoveryOutboxTest, HeartbeatsSaidAgainGoAtDoublingDistances)
{
    EXPECT_EQ(Repeat(Message().To(1).Beat(5, 1), 20000, 10),
              (std::vector{10, 110, 310, 710, 1510, 3110, 6310, 10310, 14310, 18310}));
}

TEST_F(DiscoveryOutboxTest, NewsSaidAgainGoAtGrowingDistances)
{
    EXPECT_EQ(Repeat(Message().News(1), 12000, 10), (std::vector{10, 210, 1010, 4210, 8210}));
}

TEST_F(DiscoveryOutboxTest, WhatIsNewOfASubjectDoesNotWaitForWhatWasSaidOfIt)
{
    Put(Message().To(1).Acknowledge(5, 1), 0ms);
    Run(20ms);
    Put(Message().To(1).Acknowledge(5, 2), 20ms);
    Put(Message().To(1).Acknowledge(6, 3), 30ms);
    const auto went = Run(50ms);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_EQ(went[0].At, 40ms);
}

TEST_F(DiscoveryOutboxTest, AfterARestItBeginsAnew)
{
    Repeat(Message().To(1).Beat(5, 1), 1000, 10);
    Run(2s);
    Put(Message().To(1).Beat(5, 2), 1s + DiscoveryOutbox::Rest);
    const auto went = Run(1min);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_EQ(went[0].At, 1s + DiscoveryOutbox::Rest + DiscoveryOutbox::Hold);
}

TEST_F(DiscoveryOutboxTest, AllTogetherStaysWithinItsRate)
{
    constexpr double Rate = 1000.0;
    Outbox.SetRate(Rate);
    double bytes = 0.0;
    for (int at = 0; at < 20000; at += 10)
    {
        for (int peer = 1; peer <= 100; ++peer)
        {
            Put(Message().To(static_cast<std::uint8_t>(peer)).Beat(static_cast<std::uint8_t>(at / 10), 1),
                Milliseconds(at));
        }
        bytes += OnAir(Run(Milliseconds(at + 9)));
    }
    EXPECT_LE(bytes, 1.1 * 21 * Rate);
    EXPECT_GE(bytes, 0.9 * 20 * Rate);
}

TEST_F(DiscoveryOutboxTest, ASessionThatHasJustBegunSaysAllThatItHasAtOnce)
{
    for (int number = 1; number <= 10; ++number)
    {
        Put(Message().News(static_cast<std::uint8_t>(number), 0, 500), 0ms);
    }
    const auto went = Run(10s);
    EXPECT_GE(OnAir(went), 5000.0);
    EXPECT_EQ(went.back().At, DiscoveryOutbox::Hold);
}

TEST_F(DiscoveryOutboxTest, ASessionThatHasJustBegunKeepsToARateThatWasSet)
{
    Outbox.SetRate(1000.0);
    for (int number = 1; number <= 10; ++number)
    {
        Put(Message().News(static_cast<std::uint8_t>(number), 0, 500), 0ms);
    }
    EXPECT_LE(OnAir(Run(1s)), 2000.0 + DiscoveryOutbox::LargestDatagram);
}

TEST_F(DiscoveryOutboxTest, ARestDoesNotBringTheFirstBurstBack)
{
    Outbox.Sent(6000, Start);
    for (int number = 1; number <= 10; ++number)
    {
        Put(Message().News(static_cast<std::uint8_t>(number), 0, 500), 1min);
    }
    EXPECT_LE(OnAir(Run(1min + DiscoveryOutbox::Hold)),
              DiscoveryOutbox::Burst + DiscoveryOutbox::LargestDatagram);
}

TEST_F(DiscoveryOutboxTest, WhatWasSaidToAllIsNewForWhoeverNewlyComes)
{
    EXPECT_EQ(Repeat(Message().Beat(5, 1), 1000, 10), (std::vector{10, 110, 310, 710}));
    Outbox.Received(AnswerFrom(7, 9).Datagram, Start + 1s);
    Put(Message().Beat(5, 2), 1001ms);
    auto went = Run(1s + 30ms);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_LE(went[0].At, 1001ms + DiscoveryOutbox::Hold);
    Outbox.Received(AnswerFrom(7, 9).Datagram, Start + 1040ms);
    Put(Message().Beat(5, 3), 1041ms);
    went = Run(2s);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_GE(went[0].At, 1s + DiscoveryOutbox::FirstGap);
}

TEST_F(DiscoveryOutboxTest, WhatWaitsForAllGoesAtOnceWhenSomebodyNewlyComes)
{
    Repeat(Message().Beat(5, 1), 700, 10);  // the next at 710
    Outbox.Received(AnswerFrom(7, 9).Datagram, Start + 700ms);
    const auto went = Run(1s);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_EQ(went[0].At, 700ms);
}

TEST_F(DiscoveryOutboxTest, WhatWasSaidBeforeAPeerKnewUsIsNewForIt)
{
    EXPECT_EQ(Repeat(Message().To(1).Beat(5, 1), 1000, 10), (std::vector{10, 110, 310, 710}));
    Outbox.Received(Message(AnswerFrom(1)).Datagram, Start + 1s);
    Put(Message().To(1).Beat(5, 2), 1100ms);
    const auto went = Run(1200ms);
    ASSERT_FALSE(went.empty());
    EXPECT_LE(went.back().At, 1110ms);
}

TEST_F(DiscoveryOutboxTest, QuickAnswersRaiseTheRateUpToItsMost)
{
    for (int at = 0; at < 2000; at += 20)
    {
        Put(Message().To(1).Beat(static_cast<std::uint8_t>(at / 20), 1), Milliseconds(at));
        Run(Milliseconds(at + 15));
        Outbox.Received(AnswerFrom(1).Datagram, Start + Milliseconds(at + 16));
    }
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::MostRate);
}

TEST_F(DiscoveryOutboxTest, LateAnswersLowerItOnceForWhatWasAskedBefore)
{
    for (std::uint8_t peer = 1; peer <= 5; ++peer)
    {
        Put(Message().To(peer).Beat(5, 1), 0ms);
    }
    Run(20ms);
    for (std::uint8_t peer = 1; peer <= 5; ++peer)
    {
        Outbox.Received(AnswerFrom(peer).Datagram, Start + 500ms);
    }
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::Lower);
}

TEST_F(DiscoveryOutboxTest, LateAnswersWithoutEndLeaveTheLeast)
{
    for (int at = 0; at < 60000; at += 1000)
    {
        Put(Message().To(1).Beat(static_cast<std::uint8_t>(at / 1000), 1), Milliseconds(at));
        Run(Milliseconds(at + 500));
        Outbox.Received(AnswerFrom(1).Datagram, Start + Milliseconds(at + 900));
    }
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::LeastRate);
}

TEST_F(DiscoveryOutboxTest, WhatPeersSayToHaveComeInTimeRaisesTheRateUpToItsMost)
{
    for (int at = 0; at < 60; ++at)
    {
        Outbox.CameLate(0ms, Start + DiscoveryOutbox::RaiseGap * at);
    }
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::MostRate);
}

TEST_F(DiscoveryOutboxTest, ManyPeersWhoSayItAtOnceRaiseItOnce)
{
    for (int peer = 0; peer < 10; ++peer)
    {
        Outbox.CameLate(DiscoveryOutbox::Quick, Start + Milliseconds(peer));
    }
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::FirstRaise);
}

TEST_F(DiscoveryOutboxTest, WhatPeersSayToHaveComeLateLowersTheRateOnceForEachGap)
{
    for (int peer = 0; peer < 10; ++peer)
    {
        Outbox.CameLate(DiscoveryOutbox::Late + 1ms, Start + Milliseconds(peer));
    }
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::Lower);
    Outbox.CameLate(1s, Start + DiscoveryOutbox::LowerGap);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::Lower * DiscoveryOutbox::Lower);
}

TEST_F(DiscoveryOutboxTest, ADelayThatIsNeitherQuickNorLateChangesNothing)
{
    Outbox.CameLate(DiscoveryOutbox::Late, Start);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate);
}

// As long as nobody says that the air is full, it is its own burst that it waits for.
TEST_F(DiscoveryOutboxTest, IsHeldUpOnlyWhereTheRateHasComeDown)
{
    PutMuch();
    EXPECT_FALSE(Outbox.HeldUpSince().has_value());
    Outbox.CameLate(1s, Start);
    EXPECT_EQ(Outbox.HeldUpSince(), Start + DiscoveryOutbox::Hold);
    Run(1min);
    EXPECT_FALSE(Outbox.HeldUpSince().has_value());
}

TEST_F(DiscoveryOutboxTest, IsNotHeldUpByARateThatWasSet)
{
    Outbox.SetRate(500.0);
    PutMuch();
    Outbox.CameLate(1s, Start);
    ASSERT_GT(Outbox.Due(), Start + 100ms);
    EXPECT_FALSE(Outbox.HeldUpSince().has_value());
}

TEST_F(DiscoveryOutboxTest, AnAnswerCountsOnceAndOnlyIfItIsForUs)
{
    Put(Message().To(1).Beat(5, 1), 0ms);
    Run(20ms);
    Outbox.Received(AnswerFrom(2).Datagram, Start + 30ms);
    Outbox.Received(AnswerFrom(1, 9).Datagram, Start + 30ms);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 40ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 50ms);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::FirstRaise);
}

TEST_F(DiscoveryOutboxTest, NothingIsSaidAgainBeforeAnAnswerCanBeHere)
{
    Put(Message().To(1).Beat(5, 1), 0ms);
    Run(10ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 610ms);
    Put(Message().News(1), 1s);
    Put(Message().To(2).Beat(5, 1), 1s);
    Run(1s + DiscoveryOutbox::Hold);
    Put(Message().News(1), 1100ms);
    Put(Message().To(2).Beat(5, 2), 1100ms);
    const auto went = Run(5s);
    ASSERT_FALSE(went.empty());
    EXPECT_EQ(went.front().At, 1s + DiscoveryOutbox::Hold + 1200ms);
}

// Where peers are listed, a round of announcements goes to each of the ports of each.
TEST_F(DiscoveryOutboxTest, ARoundOfAnnouncementsIsMissingOnceFromARateThatNobodySet)
{
    Meet(1, 3);
    for (int place = 0; place < 32; ++place)
    {
        Outbox.Announced(Message::Bytes(364, 0x52), Start + Milliseconds(place / 8));
    }
    Put(Message().To(1).News(1, 4, 400), 4ms, 1, std::nullopt);
    Put(Message().To(2).News(1, 4, 400), 4ms, 2, std::nullopt);
    const auto went = Run(1s);
    ASSERT_EQ(went.size(), 2u);
    EXPECT_EQ(went[1].At, 4ms + DiscoveryOutbox::Hold);
}

TEST_F(DiscoveryOutboxTest, EachRoundOfAnnouncementsIsMissing)
{
    Meet(1, 3);
    for (int round = 0; round < 30; ++round)
    {
        Outbox.Announced(Message::Bytes(364, 0x52), Start + Milliseconds(100 * round));
    }
    Put(Message().To(1).News(1, 4, 400), 2901ms, 1, std::nullopt);
    Put(Message().To(2).News(1, 4, 400), 2901ms, 2, std::nullopt);
    Put(Message().To(3).News(1, 4, 400), 2901ms, 3, std::nullopt);
    const auto went = Run(5s);
    ASSERT_EQ(went.size(), 3u);
    EXPECT_GT(went[2].At, 2901ms + DiscoveryOutbox::Hold);
}

TEST_F(DiscoveryOutboxTest, AllOfARoundOfAnnouncementsIsMissingFromARateThatWasSet)
{
    Meet(1, 3);
    Outbox.SetRate(1000.0);
    for (int place = 0; place < 32; ++place)
    {
        Outbox.Announced(Message::Bytes(364, 0x52), Start);
    }
    Put(Message().To(1).News(1, 4, 400), 0ms, 1, std::nullopt);
    Put(Message().To(2).News(1, 4, 400), 0ms, 2, std::nullopt);
    const auto went = Run(2s);
    ASSERT_EQ(went.size(), 2u);
    EXPECT_GT(went[1].At, 400ms);
}

// A peer that we heard answers only when it has heard us.
TEST_F(DiscoveryOutboxTest, AFirstAnswerThatWaitedForAnAnnouncementIsNotLate)
{
    Put(Message().To(1).Beat(5, 1), 0ms, 1, std::nullopt);
    Run(20ms);
    Outbox.Announced(Message::Bytes(364, 0x52), Start + 700ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 780ms);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate);
    EXPECT_LE(Outbox.AnswerTime(), 80ms);
}

TEST_F(DiscoveryOutboxTest, AFirstAnswerIsTakenForOneToWhatWasSaidLast)
{
    Put(Message().To(1).Beat(5, 1), 0ms, 1, std::nullopt);
    Run(20ms);
    Put(Message().To(1).Beat(5, 2), 500ms, 1, std::nullopt);
    Run(520ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 550ms);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::FirstRaise);
}

TEST_F(DiscoveryOutboxTest, AFirstAnswerThatIsLateForAllThatWasSaidHasTakenItsWholeTime)
{
    Put(Message().To(1).Beat(5, 1), 0ms, 1, std::nullopt);
    Run(20ms);
    Outbox.Announced(Message::Bytes(364, 0x52), Start + 200ms);
    Put(Message().To(1).Beat(5, 2), 300ms, 1, std::nullopt);
    Run(320ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 810ms);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::Lower);
    EXPECT_EQ(Outbox.AnswerTime(), 800ms);
}

TEST_F(DiscoveryOutboxTest, AfterAFirstAnswerThatSaysNothingOfTheTimeTheNextOneCounts)
{
    Put(Message().To(1).Beat(5, 1), 0ms, 1, std::nullopt);
    Run(20ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 200ms);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 250ms);
    Put(Message().To(1).Beat(5, 2), 500ms, 1, std::nullopt);
    Run(520ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 550ms);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::FirstRaise);
}

TEST_F(DiscoveryOutboxTest, WhoHearsTheGroupIsLateWhateverWasSaidMeanwhile)
{
    Put(Message().To(1).Beat(5, 1), 0ms);
    Run(20ms);
    Put(Message().To(1).Beat(5, 2), 400ms);
    Run(450ms);
    Outbox.Announced(Message::Bytes(364, 0x52), Start + 450ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 460ms);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::Lower);
}

TEST_F(DiscoveryOutboxTest, WhoHasAnsweredOnceIsLateWhateverWasSaidMeanwhile)
{
    Put(Message().To(1).Beat(5, 1), 0ms, 1, std::nullopt);
    Run(20ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 200ms);
    Put(Message().To(1).Beat(6, 2), 1000ms, 1, std::nullopt);
    Run(1020ms);
    Put(Message().To(1).Beat(6, 3), 1400ms, 1, std::nullopt);
    Run(1450ms);
    Outbox.Announced(Message::Bytes(364, 0x52), Start + 1500ms);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 1510ms);
    EXPECT_EQ(Outbox.Rate(), DiscoveryOutbox::FirstRate * DiscoveryOutbox::Lower);
}

// They would be lost, and missing from what others need.
TEST_F(DiscoveryOutboxTest, NewsForOneAloneWaitUntilItKnowsUs)
{
    Put(Message().To(1).News(1, 4, 400), 0ms, 1, std::nullopt);
    Put(Message().To(1).News(2, 4, 400), 0ms, 1, std::nullopt);
    Put(Message().To(2).News(1, 4, 400), 0ms, 2, std::nullopt);
    Put(Message().To(1).Beat(2, 1), 0ms, 1, std::nullopt);
    const auto before = Run(150ms);
    ASSERT_EQ(before.size(), 1u);
    EXPECT_EQ(before[0].Bytes, Message().To(1).Beat(2, 1).Datagram);
    Outbox.Received(AnswerFrom(1).Datagram, Start + 200ms);
    const auto after = Run(1s);
    ASSERT_EQ(after.size(), 1u);
    EXPECT_EQ(after[0].At, 200ms);
    EXPECT_EQ(after[0].Bytes, Message().To(1).News(1, 4, 400).News(2, 4, 400).Datagram);
}

TEST_F(DiscoveryOutboxTest, WhoHasSaidSomethingToUsKnowsUs)
{
    Message heartbeat;
    std::fill_n(heartbeat.Datagram.begin() + 8, 12, std::uint8_t{1});
    Outbox.Announced(Message().Datagram, Start);
    Outbox.Received(heartbeat.To(0x52).Beat(3, 1).Datagram, Start + 100ms);
    Put(Message().To(1).News(1, 4), 200ms, 1, std::nullopt);
    EXPECT_EQ(Run(1s).size(), 1u);
}

TEST_F(DiscoveryOutboxTest, AnAnswerDoesNotWaitBehindNews)
{
    Outbox.SetRate(1000.0);
    for (std::uint8_t number = 1; number <= 5; ++number)
    {
        Put(Message().News(number, 0, 500), 0ms, number, number);
    }
    Run(100ms);
    Put(Message().To(1).Acknowledge(5, 1), 100ms, 9, std::nullopt);
    const auto went = Run(10s);
    ASSERT_FALSE(went.empty());
    EXPECT_EQ(went[0].Address, 9u);
}

TEST_F(DiscoveryOutboxTest, AnAnswerDoesNotWaitBehindNewsHoweverLongTheyHaveWaited)
{
    Outbox.SetRate(1000.0);
    for (std::uint8_t number = 1; number <= 20; ++number)
    {
        Put(Message().News(number, 0, 1000), 0ms);
    }
    Run(10s);
    Put(Message().To(1).Acknowledge(5, 1), 10s);
    const auto went = Run(12s);
    ASSERT_FALSE(went.empty());
    EXPECT_LT(went[0].Bytes.size(), 100u);
}

TEST_F(DiscoveryOutboxTest, AnswersWithoutEndLetNewsPass)
{
    Outbox.SetRate(1000.0);
    std::optional<Milliseconds> passed;
    for (int at = 0; at < 20000 && !passed; at += 100)
    {
        if (at == 5000)
        {
            Put(Message().News(1), 5s, 200, 200);
        }
        for (std::uint8_t peer = 1; peer <= 50; ++peer)
        {
            Put(Message().To(peer).Acknowledge(static_cast<std::uint8_t>(at / 100), 1), Milliseconds(at),
                peer, std::nullopt);
        }
        for (const Went &went : Run(Milliseconds(at + 99)))
        {
            passed = went.Address == 200 ? std::optional(went.At) : passed;
        }
    }
    // All that is said in turn is 5 kB.
    ASSERT_TRUE(passed.has_value());
    EXPECT_LE(*passed, 5s + 6s);
}

TEST_F(DiscoveryOutboxTest, NobodyIsPassedOver)
{
    Outbox.SetRate(1000.0);
    std::vector<int> said(101);
    for (int at = 0; at < 60000; at += 100)
    {
        for (int peer = 1; peer <= 100; ++peer)
        {
            Put(Message().To(static_cast<std::uint8_t>(peer)).Beat(static_cast<std::uint8_t>(at / 100), 1),
                Milliseconds(at), static_cast<std::uint64_t>(peer), std::nullopt);
        }
        for (const Went &went : Run(Milliseconds(at + 99)))
        {
            ++said[went.Address];
        }
    }
    const auto [least, most] = std::minmax_element(said.begin() + 1, said.end());
    EXPECT_GT(*least, 0);
    EXPECT_LE(*most, *least + 2);
}

TEST_F(DiscoveryOutboxTest, WhatGoesPastItIsMissingFromItsRate)
{
    Outbox.SetRate(1000.0);
    Outbox.Sent(900, Start);
    Put(Message().News(1, 0, 400), 0ms);
    Put(Message().News(2, 0, 400), 0ms);
    const auto went = Run(10s);
    ASSERT_EQ(went.size(), 2u);
    EXPECT_EQ(went[0].At, DiscoveryOutbox::Hold);
    EXPECT_GT(went[1].At, 300ms);
}

TEST_F(DiscoveryOutboxTest, HoweverMuchGoesPastItItComesToSpeak)
{
    Outbox.SetRate(1000.0);
    Put(Message().News(1, 0, 400), 0ms);
    Put(Message().News(2, 0, 400), 0ms);
    std::size_t went = 0;
    for (int at = 0; at < 2000; at += 100)
    {
        Outbox.Sent(5000, Start + Milliseconds(at));
        went += Run(Milliseconds(at + 99)).size();
    }
    EXPECT_EQ(went, 2u);
}

TEST_F(DiscoveryOutboxTest, NoDatagramOfSeveralPartsIsLargerThanItMayBe)
{
    for (int number = 1; number <= 20; ++number)
    {
        Put(Message().News(static_cast<std::uint8_t>(number), 0, 300), 0ms);
    }
    Put(Message().News(21, 0, 2000), 0ms);
    int larger = 0;
    for (const Went &went : Run(10s))
    {
        larger += went.Bytes.size() > DiscoveryOutbox::LargestDatagram ? 1 : 0;
    }
    EXPECT_EQ(larger, 1);  // which cannot be cut
}

TEST_F(DiscoveryOutboxTest, NewsGoInTheOrderInWhichTheyCame)
{
    for (const int number : {3, 1, 2})
    {
        Put(Message().News(static_cast<std::uint8_t>(number)), 0ms);
    }
    const auto went = Run(100ms);
    ASSERT_EQ(went.size(), 1u);
    EXPECT_EQ(went[0].Bytes, Message().News(3).News(1).News(2).Datagram);
}

TEST_F(DiscoveryOutboxTest, PeersWithoutEndDoNotFillTheMemory)
{
    const auto message = Message().To(1).Beat(5, 1).Datagram;
    auto part = Rabit::ReadDiscoveryParts(message)->front();
    Milliseconds at{};
    for (std::uint32_t peer = 0; peer < 3 * DiscoveryOutbox::MostSlots; ++peer)
    {
        part.About.To[0] = static_cast<std::uint8_t>(peer);
        part.About.To[1] = static_cast<std::uint8_t>(peer >> 8);
        part.About.To[2] = static_cast<std::uint8_t>(peer >> 16);
        Outbox.Put(message, part, {.Address = 1, .Group = {}}, Start + at);
        at += 500ms;
        Run(at);
        ASSERT_LE(Outbox.Size(), 1300u) << "600 come in five minutes";
    }
}

TEST_F(DiscoveryOutboxTest, SubjectsWithoutEndDoNotFillTheMemory)
{
    for (std::uint64_t address = 0; address < 3 * DiscoveryOutbox::MostSlots; ++address)
    {
        Put(Message().To(1).Beat(5, 1), 0ms, address, std::nullopt);
        ASSERT_LE(Outbox.Size(), DiscoveryOutbox::MostSlots);
    }
}

}  // namespace
