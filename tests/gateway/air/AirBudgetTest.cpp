#include "air/AirBudget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <utility>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = AirBudget::Duration;

constexpr std::size_t Largest = 1428;

// Sends datagrams of the sizes `size(i)` as soon as the budget allows, and records them.
struct Traffic
{
    std::deque<std::pair<Duration, std::size_t>> Sent;

    template <typename Size>
    void Run(AirBudget &budget, const Size &size, Duration from, Duration to, Duration lateness = 0ns)
    {
        for (Duration now = from;;)
        {
            const auto bytes = static_cast<std::size_t>(size(Sent.size()));
            now = budget.WhenFits(bytes, now);
            if (now > from)
            {
                now += lateness;
            }
            if (now >= to)
            {
                return;
            }
            ASSERT_TRUE(budget.MaySend(bytes, now));
            budget.Sent(bytes, now);
            Sent.emplace_back(now, bytes);
        }
    }

    std::size_t Total() const
    {
        std::size_t total = 0;
        for (const auto &[at, bytes] : Sent)
        {
            total += bytes;
        }
        return total;
    }

    // Returns the most bytes of any second that ends with a datagram.
    std::size_t MostInASecond() const
    {
        std::size_t most = 0;
        std::size_t sum = 0;  // of those from `first` up to the present one
        auto first = Sent.begin();
        for (const auto &[at, bytes] : Sent)
        {
            sum += bytes;
            for (; at - first->first >= 1s; ++first)
            {
                sum -= first->second;
            }
            most = std::max(most, sum);
        }
        return most;
    }
};

TEST(AirBudget, WithoutALimitEverythingGoesAtOnce)
{
    AirBudget budget(Largest);
    for (int i = 0; i < 1000; ++i)
    {
        EXPECT_TRUE(budget.MaySend(60'000, 1s));
        budget.Sent(60'000, 1s);
    }
    EXPECT_TRUE(budget.IsUnlimited());
    EXPECT_FALSE(budget.Rate());
    EXPECT_EQ(budget.LargestDatagram(), Largest);
}

TEST(AirBudget, NoSecondHasMoreThanTheBudget)
{
    for (const double rate : {500.0, 1500.0, 5000.0, 40'000.0, 1e6})
    {
        AirBudget budget(Largest);
        budget.SetBudget(rate, 0ns);
        Traffic traffic;
        traffic.Run(
            budget, [](std::size_t i) { return 100 + i * 37 % 300; }, 0ns, 20s);
        EXPECT_LE(static_cast<double>(traffic.MostInASecond()), rate) << rate;
        EXPECT_GE(static_cast<double>(traffic.Total()), 0.9 * 20 * (rate - 400))
            << rate;  // less what a datagram leaves over
    }
}

TEST(AirBudget, DatagramsAlmostAsLargeAsTheBudgetGoOnceASecond)
{
    AirBudget budget(Largest);
    budget.SetBudget(1500, 0ns);
    Traffic traffic;
    traffic.Run(
        budget, [](std::size_t) { return 1400; }, 0ns, 60s);
    EXPECT_EQ(traffic.MostInASecond(), 1400u);
    EXPECT_GE(traffic.Sent.size(), 55u);
}

TEST(AirBudget, AfterAPauseThereIsNoBurst)
{
    AirBudget budget(Largest);
    budget.SetBudget(4000, 0ns);
    Traffic traffic;
    traffic.Run(
        budget, [](std::size_t) { return 200; }, 0ns, 2s);
    traffic.Sent.clear();
    traffic.Run(
        budget, [](std::size_t) { return 200; }, 60s, 61s);
    ASSERT_GE(traffic.Sent.size(), 3u);
    EXPECT_GE(traffic.Sent[2].first - traffic.Sent[0].first, 85ms);
}

TEST(AirBudget, ADatagramLargerThanASecondsBudgetGoesWhenNothingWentForASecond)
{
    AirBudget budget(Largest);
    budget.SetBudget(500, 0ns);
    budget.Sent(100, 1s);
    EXPECT_GE(budget.WhenFits(1400, 1s), 2s);
    EXPECT_LE(budget.WhenFits(1400, 1s), 2100ms);
    budget.Sent(1400, 3s);
    // The datagram takes its time: 1400 bytes take 2.8 s.
    EXPECT_GE(budget.WhenFits(100, 3s), 5800ms);
}

TEST(AirBudget, WhatFitsAtATimeMaySendThen)
{
    AirBudget budget(Largest);
    budget.SetBudget(3000, 0ns);
    for (std::size_t i = 0; i < 1000; ++i)
    {
        const std::size_t bytes = 50 + i * 131 % 1300;
        const Duration now = AirBudget(budget).WhenFits(bytes, i * 50ms);
        EXPECT_TRUE(now == i * 50ms || !AirBudget(budget).MaySend(bytes, now - 1ms));
        EXPECT_TRUE(AirBudget(budget).MaySend(bytes, now));
        if (i % 7 == 0 && now < (i + 1) * 50ms)
        {
            budget.Sent(bytes, now);
        }
    }
}

TEST(AirBudget, WhatWasNotScheduledEatsFromABudget)
{
    AirBudget budget(Largest);
    budget.SetBudget(2000, 0ns);
    budget.Spent(1500, 10s);
    budget.Sent(100, 10s);
    EXPECT_TRUE(budget.MaySend(400, 10100ms));
    EXPECT_FALSE(budget.MaySend(401, 10100ms));
    EXPECT_GE(budget.WhenFits(401, 10100ms), 11s);
}

TEST(AirBudget, WhatIsReservedPaysForWhatIsNotScheduled)
{
    AirBudget budget(Largest);
    budget.SetBudget(2000, 0ns);
    budget.Reserve(500);
    Traffic traffic;
    traffic.Run(
        budget, [](std::size_t) { return 100; }, 0ns, 10s);
    EXPECT_LE(traffic.MostInASecond(), 1500u);
    const Duration before = budget.WhenFits(100, 10s);
    budget.Spent(500, 10s);
    EXPECT_EQ(budget.WhenFits(100, 10s), before);
    budget.Spent(100, 10s);
    EXPECT_GT(budget.WhenFits(100, 10s), before);
}

TEST(AirBudget, AReserveLeavesHalfOfTheBudget)
{
    AirBudget budget(Largest);
    budget.SetBudget(2000, 0ns);
    budget.Reserve(1e9);
    Traffic traffic;
    traffic.Run(
        budget, [](std::size_t) { return 100; }, 0ns, 10s);
    EXPECT_GE(traffic.Total(), 8000u);
}

TEST(AirBudget, SomethingGoesHoweverMuchWasNotScheduled)
{
    AirBudget budget(Largest);
    budget.SetBudget(2000, 0ns);
    int sent = 0;
    for (Duration now = 0s; now < 20s; now += 10ms)
    {
        budget.Spent(100, now);
        if (budget.MaySend(200, now))
        {
            budget.Sent(200, now);
            ++sent;
        }
    }
    EXPECT_GE(sent, 15);
}

TEST(AirBudget, APaceHasItsRateOnAverageThoughTheDriverIsLate)
{
    AirBudget budget(Largest);
    budget.SetPace(100'000, 0ns);
    Traffic traffic;
    traffic.Run(
        budget, [](std::size_t) { return 1000; }, 0ns, 10s, 2ms);
    EXPECT_GE(traffic.Total(), 980'000u);
    EXPECT_LE(traffic.Total(), 1'002'000u);
}

TEST(AirBudget, ALateDriverCatchesUpTenMillisecondsAndNoMore)
{
    AirBudget budget(Largest);
    budget.SetPace(100'000, 0ns);
    int sent = 0;
    while (budget.MaySend(100, 5s))
    {
        budget.Sent(100, 5s);
        ++sent;
    }
    EXPECT_EQ(sent, 11);
}

TEST(AirBudget, WhatWasNotScheduledHoldsUpAPaceForASecondAtMost)
{
    AirBudget budget(Largest);
    budget.SetPace(1000, 0ns);
    budget.Spent(500, 10s);
    EXPECT_EQ(budget.WhenFits(100, 10s), 10500ms);
    budget.Spent(50'000, 10s);
    EXPECT_EQ(budget.WhenFits(100, 10s), 11s);
}

TEST(AirBudget, WhatIsNeverOverAndNotScheduledLeavesAPaceSomethingEachSecond)
{
    AirBudget budget(Largest);
    budget.SetPace(300, 0ns);
    int sent = 0;
    for (Duration now = 10s; now < 30s; now += 10ms)
    {
        budget.Spent(100, now);
        if (budget.MaySend(100, now))
        {
            budget.Sent(100, now);
            ++sent;
        }
    }
    EXPECT_GE(sent, 14);
}

TEST(AirBudget, WhatIsNeverOverLeavesAPaceSomethingThoughTheRateIsSetAgainAndAgain)
{
    AirBudget budget(Largest);
    int sent = 0;
    for (Duration now = 10s; now < 30s; now += 100ms)
    {
        budget.SetPace(now % 200ms == 0s ? 440 : 441, now);
        if (now % 1s == 0s)
        {
            budget.Spent(441, now);
        }
        if (budget.MaySend(100, now))
        {
            budget.Sent(100, now);
            ++sent;
        }
    }
    EXPECT_GE(sent, 10);
}

TEST(AirBudget, APaceThatFallsFarHoldsUpNobodyForLong)
{
    AirBudget budget(Largest);
    budget.SetPace(1'000'000, 10s);
    budget.Spent(50'000'000, 10s);
    budget.SetPace(100, 10s);
    EXPECT_LE(budget.WhenFits(100, 10s), 11s);
}

TEST(AirBudget, AHigherRateHoldsForADatagramThatIsUnderWay)
{
    AirBudget budget(Largest);
    budget.SetPace(1000, 0ns);
    budget.Sent(1000, 10s);
    EXPECT_NEAR(std::chrono::duration<double>(budget.WhenFits(1, 10s)).count(), 10.99, 0.001);
    budget.SetPace(10'000, 10s);
    EXPECT_NEAR(std::chrono::duration<double>(budget.WhenFits(1, 10s)).count(), 10.099, 0.001);
}

TEST(AirBudget, DatagramsAreAsLargeAsAQuarterOfASecondWithinLimits)
{
    AirBudget budget(Largest);
    budget.SetBudget(1000, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), 400u);
    budget.SetBudget(4000, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), 1000u);
    budget.SetBudget(1e6, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), Largest);
}

TEST(AirBudget, DatagramsOfASmallBudgetMayTakeLongerThanTheyWouldAsSmallOnes)
{
    AirBudget budget(Largest);
    budget.SetBudget(1200, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), 480u);
    budget.SetBudget(1500, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), 576u);
    budget.SetBudget(2304, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), 576u);
    budget.SetBudget(2400, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), 600u);
}

TEST(AirBudget, WithAPaceDatagramsGrowMoreSlowlyThanTheRate)
{
    // A radio that gives turns carries more for larger datagrams. A node with a higher rate must not get
    // more of it by that.
    AirBudget budget(Largest);
    budget.SetPace(1000, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), 400u);
    budget.SetPace(6400, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), 800u);
    budget.SetPace(1e6, 0ns);
    EXPECT_EQ(budget.LargestDatagram(), Largest);
}

TEST(AirBudget, APaceBelowABudgetSpacesDatagramsAndFillsNoSecond)
{
    AirBudget budget(Largest);
    budget.SetLimits(12500, 500, 0ns);
    budget.Reserve(250);
    budget.Sent(150, 1s);
    EXPECT_EQ(budget.WhenFits(104, 1s), 1290ms) << "a late driver catches up 10 ms";
    EXPECT_EQ(budget.Rate(), 500);
}

TEST(AirBudget, ABudgetBelowAPaceHolds)
{
    AirBudget budget(Largest);
    budget.SetLimits(1000, 50000, 0ns);
    Traffic traffic;
    traffic.Run(
        budget, [](std::size_t) { return 100; }, 0s, 10s);
    EXPECT_LE(traffic.MostInASecond(), 1000U);
    EXPECT_GE(traffic.Total(), 9000U);
    EXPECT_EQ(budget.Rate(), 1000);
}

TEST(AirBudget, TheRoomIsWhatMayGoNow)
{
    AirBudget budget(Largest);
    EXPECT_EQ(budget.Room(500, 1s), 500U) << "without a limit";
    budget.SetBudget(1500, 1s);
    EXPECT_EQ(budget.Room(9000, 1s), 9000U) << "something always goes";
    budget.Sent(1000, 1s);
    budget.Spent(200, 1s);
    EXPECT_EQ(budget.Room(500, 2s), 300U);
    EXPECT_EQ(budget.Room(200, 2s), 200U);
    budget.Sent(400, 2s);
    EXPECT_EQ(budget.Room(500, 2s), 0U);
}

}  // namespace
}  // namespace Rabit
