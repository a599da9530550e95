// How far heartbeats and gaps may move the vendor (AbsentNumbers, WalkBudget, and both in the guard).
#include "guard/AbsentNumbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "common/RtpsReader.h"
#include "guard/Gate.h"

namespace
{

using namespace RtpsBytes;
using namespace std::chrono_literals;
using Rabit::Rtps::AbsentNumbers;
using Rabit::Rtps::RtpsGuard;
using Rabit::Rtps::WalkBudget;

constexpr std::int64_t Million = 1'000'000;

TEST(WalkBudget, GrantsAFewStepsAtAnyTimeAndManyAtFirst)
{
    const WalkBudget::TimePoint now{1h};
    WalkBudget budget;
    EXPECT_EQ(budget.Take(WalkBudget::Free, now), WalkBudget::Free);
    EXPECT_EQ(budget.Take(std::int64_t{1} << 39, now), WalkBudget::Free + WalkBudget::Burst);
    EXPECT_EQ(budget.Take(std::int64_t{1} << 39, now), WalkBudget::Free);
    EXPECT_EQ(budget.Take(std::int64_t{1} << 39, now - 1h), WalkBudget::Free) << "a clock does not go back";
}

TEST(WalkBudget, GrantsSoManyInASecondAndNeverMoreThanTheBurst)
{
    WalkBudget::TimePoint now{1h};
    WalkBudget budget;
    budget.Take(std::int64_t{1} << 39, now);
    now += 1s;
    EXPECT_EQ(budget.Take(std::int64_t{1} << 39, now), WalkBudget::Free + WalkBudget::InASecond);
    now += std::chrono::hours(24 * 365);
    EXPECT_EQ(budget.Take(std::int64_t{1} << 39, now), WalkBudget::Free + WalkBudget::Burst);
}

class AbsentNumbersTest : public testing::Test
{
protected:
    AbsentNumbersTest() { _numbers.Acknowledged(0); }
    std::int64_t FirstOf(std::int64_t first) { return _numbers.FirstOf(first, _budget, _now); }
    // {First, Base} of the part that the vendor gets; empty: nothing.
    std::vector<std::int64_t> PartOf(std::int64_t first, std::int64_t base, std::int64_t last)
    {
        const auto part = _numbers.PartOf({first, base, last}, _budget, _now);
        return part ? std::vector{part->First, part->Base} : std::vector<std::int64_t>{};
    }

    AbsentNumbers _numbers;
    WalkBudget _budget;
    WalkBudget::TimePoint _now{1h};
};

TEST_F(AbsentNumbersTest, AReaderThatJoinsLateIsAtTheWritersNumberAtOnce)
{
    EXPECT_EQ(FirstOf(3 * Million), 3 * Million);
}

TEST_F(AbsentNumbersTest, AReaderThatJoinsAYoungWriterIsThereAlthoughTheBudgetIsSpent)
{
    _budget.Take(std::int64_t{1} << 39, _now);
    EXPECT_EQ(FirstOf(200), 200);
}

TEST_F(AbsentNumbersTest, AReaderThatJoinsAWriterAtABillionGetsThereByAndBy)
{
    constexpr std::int64_t Billion = 1000 * Million;
    std::int64_t reached = FirstOf(Billion);
    EXPECT_EQ(reached, WalkBudget::Burst + WalkBudget::Free + 1);
    for (int i = 0; reached < Billion && i < 4000; ++i)
    {
        _now += 1s;
        const std::int64_t next = FirstOf(Billion);
        ASSERT_LE(next - reached, WalkBudget::InASecond + WalkBudget::Free);
        reached = next;
    }
    EXPECT_EQ(reached, Billion);
}

TEST_F(AbsentNumbersTest, AWriterThatIsHeardTakesNothingOfTheBudget)
{
    _budget.Take(std::int64_t{1} << 39, _now);
    for (std::int64_t number = 1; number <= 100'000; ++number)
    {
        _numbers.Given(number);
    }
    EXPECT_EQ(FirstOf(100'001), 100'001);
    _numbers.Acknowledged(150'001);
    EXPECT_EQ(FirstOf(150'001), 150'001);
}

// A reader that was made later than others begins at the first number.
TEST_F(AbsentNumbersTest, WhatTheVendorAcknowledgesIsWhereItIs)
{
    _numbers.Acknowledged(Million);
    _numbers.Acknowledged(1);
    _budget.Take(std::int64_t{1} << 39, _now);
    EXPECT_EQ(FirstOf(Million), WalkBudget::Free + 1);
}

TEST_F(AbsentNumbersTest, AWriterThatIsAnnouncedAgainHasTheFreeStepsAloneUntilTheVendorAcknowledges)
{
    _numbers.Acknowledged(Million);
    _numbers.Announced();
    EXPECT_EQ(FirstOf(Million), WalkBudget::Free + 1);
    _numbers.Acknowledged(Million);
    EXPECT_EQ(FirstOf(Million + 10), Million + 10);
}

TEST_F(AbsentNumbersTest, AGapBehindTheLastNumberPassesAndAWideOneIsCut)
{
    _numbers.Acknowledged(11);
    EXPECT_THAT(PartOf(11, 13, 20), testing::ElementsAre(11, 13));
    _budget.Take(std::int64_t{1} << 39, _now);
    EXPECT_THAT(PartOf(13, Million, Million + 200), testing::ElementsAre(13, 13 + WalkBudget::Free));
    EXPECT_THAT(PartOf(13, Million, Million + 200),
                testing::ElementsAre(13 + WalkBudget::Free, 13 + 2 * WalkBudget::Free));
}

TEST_F(AbsentNumbersTest, AGapOfNumbersThatTheVendorHasTakesNoStep)
{
    _numbers.Acknowledged(Million);
    EXPECT_THAT(PartOf(1, Million, Million - 1), testing::ElementsAre(Million, Million));
    EXPECT_THAT(PartOf(1, Million - 5, Million + 5), testing::ElementsAre(Million - 5, Million - 5));
}

TEST_F(AbsentNumbersTest, AGapBehindAMissingSampleIsShort)
{
    _numbers.Acknowledged(11);
    EXPECT_THAT(PartOf(13, 20, 20), testing::ElementsAre(13, 20));
    EXPECT_THAT(PartOf(13, 14, 10 + AbsentNumbers::FewAhead), testing::ElementsAre(13, 14));
    EXPECT_THAT(PartOf(13, 14, 11 + AbsentNumbers::FewAhead), testing::IsEmpty());
}

// The number in a heartbeat or a gap behind its two entities.
std::int64_t FirstIn(const Bytes &message)
{
    constexpr std::size_t FirstAt = 20 + 4 + 8;
    return Rabit::Rtps::RtpsReader(std::span(message).subspan(FirstAt), true).Sequence();
}

Bytes Acknowledgement(std::int64_t base)
{
    return Join({Header(Other), Submessage(InfoDestination, Bytes(Sender.begin(), Sender.end())),
                 Submessage(AckNack, AckNackBody(base, 0, 1))});
}

// CVE-2025-65016: twelve heartbeats of a discovery writer whose first number is 2^39 and rises. Fast DDS
// stepped through all of these numbers.
TEST(AbsentNumbersInTheGuard, HeartbeatsThatRiseMoveTheVendorNoFartherThanTheBudget)
{
    constexpr Rabit::Rtps::EntityId Publications = 0x000003c2;
    Gate guard;
    ASSERT_TRUE(guard.Passes(ParticipantMessage()));
    std::int64_t reached = 1;
    for (std::uint32_t i = 0; i < 20; ++i)
    {
        const std::int64_t first = (std::int64_t{1} << 39) + i;
        guard.Admit(Message(Heartbeat, HeartbeatBody(first, first - 1, i + 1, Publications)));
        if (!guard.Handed.empty())
        {
            const std::int64_t given = FirstIn(guard.Handed.front());
            ASSERT_LE(given - reached, WalkBudget::Burst + WalkBudget::Free);
            reached = given;
            // The vendor answers, which an opponent has it do.
            guard.Sending(
                Join({Header(Other), Submessage(InfoDestination, Bytes(Sender.begin(), Sender.end())),
                      Submessage(AckNack, AckNackBody(reached, 0, i + 1, Publications))}));
        }
    }
    EXPECT_GT(reached, 1);
    EXPECT_LE(reached, WalkBudget::Burst + 20 * (WalkBudget::Free + 1));
}

// Without announcement, acknowledgement or time, as many numbers as datagrams pay for.
TEST(AbsentNumbersInTheGuard, AnAnnouncementRepeatedByAnOpponentGivesNoSteps)
{
    Gate guard;
    ASSERT_TRUE(guard.Passes(ParticipantMessage()));
    ASSERT_TRUE(guard.Passes(WriterMessage()));
    guard.Sending(Acknowledgement(0));
    guard.Admit(Message(Heartbeat, HeartbeatBody(4 * Million, 4 * Million, 1)));
    ASSERT_EQ(FirstIn(guard.Handed.front()), 4 * Million);
    for (std::uint32_t i = 2; i < 20; ++i)
    {
        // The vendor may have forgotten the writer meanwhile.
        ASSERT_TRUE(guard.Admit(WriterMessage()));
        guard.Admit(Message(Heartbeat, HeartbeatBody(4 * Million, 4 * Million, i)));
        EXPECT_EQ(FirstIn(guard.Handed.front()), WalkBudget::Free + 1);
    }
}

TEST(AbsentNumbersInTheGuard, CycloneDdsWhichDoesNotStepGetsEachHeartbeatAsItIs)
{
    Gate guard(RtpsGuard::Mode::Full, RtpsGuard::Vendor::CycloneDds);
    ASSERT_TRUE(guard.Passes(ParticipantMessage()));
    ASSERT_TRUE(guard.Passes(WriterMessage()));
    ASSERT_TRUE(guard.Admit(Message(Heartbeat, HeartbeatBody(4 * Million, 4 * Million, 1))));
    EXPECT_EQ(FirstIn(guard.Handed.front()), 4 * Million);
}

}  // namespace
