#include "air/CapacityEstimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = CapacityEstimate::Duration;

double Seconds(Duration time)
{
    return std::chrono::duration<double>(time).count();
}

// A node that offers `Offered` bytes a second, in front of a buffer of 16 kB that carries `Carries`. Two
// peers report twice a second.
class CapacityEstimateTest : public ::testing::Test
{
protected:
    double Offered = 100e3;  // bytes a second
    double Carries = 10e3;
    std::function<bool(Duration)> Reports = [](Duration) { return true; };

    void RunUntil(Duration end)
    {
        for (; _now < end; _now += 10ms)
        {
            const double rate = std::min(Offered, Estimate.Rate(_now).value_or(1e12));
            _owed += rate * 0.01;
            const auto bytes = static_cast<std::size_t>(_owed);
            _owed -= static_cast<double>(bytes);
            if (bytes > 0)
            {
                Estimate.Sent(bytes, _now);
            }
            Backlog = std::min(Backlog + static_cast<double>(bytes), 16384.0);
            Carried += std::min(Backlog, Carries * 0.01);
            Backlog = std::max(Backlog - Carries * 0.01, 0.0);
            // The delay of a datagram that arrives now: the time since it was sent, with the backlog of
            // then in front of it.
            _delay = Backlog > 0.0 ? std::min(_delay + 10ms, Duration(std::llround(Backlog / Carries * 1e9)))
                                   : 0ns;
            for (CapacityEstimate::Peer peer = 0; peer < 2; ++peer)
            {
                if (_now % 500ms == peer * 250ms && Reports(_now))
                {
                    Estimate.Reported(peer, _delay, _now, _now);
                }
            }
            LongestQueue = std::max(LongestQueue, Backlog / Carries);
        }
    }

    double Rate() const { return Estimate.Rate(_now).value_or(-1.0); }

    CapacityEstimate Estimate;
    double Backlog = 0.0;
    double Carried = 0.0;
    double LongestQueue = 0.0;  // seconds

private:
    Duration _now{0};
    Duration _delay{0};
    double _owed = 0.0;
};

TEST_F(CapacityEstimateTest, IsUnlimitedWithoutReportsHoweverMuchIsSent)
{
    Reports = [](Duration) { return false; };
    RunUntil(60s);
    EXPECT_FALSE(Estimate.Rate(60s));
}

TEST_F(CapacityEstimateTest, IsUnlimitedWhileNothingIsLate)
{
    Carries = 1e6;
    RunUntil(60s);
    EXPECT_FALSE(Estimate.Rate(60s));
}

TEST_F(CapacityEstimateTest, OneLateDatagramIsNoCongestion)
{
    Carries = 1e6;
    RunUntil(10s);
    Estimate.Reported(0, 800ms, 10s, 10s);
    Estimate.Reported(1, 750ms, 10s, 10s);
    EXPECT_FALSE(Estimate.Rate(10s));
    RunUntil(20s);
    EXPECT_FALSE(Estimate.Rate(20s));
}

TEST_F(CapacityEstimateTest, WhatRisesIsLimitedToWhatWasCarried)
{
    Offered = 30e3;
    Duration now = 0ns;
    while (!Estimate.Rate(now) && now < 10s)
    {
        now += 10ms;
        RunUntil(now);
    }
    double highest = 0.0;
    for (const Duration end = now + 10s; now < end; now += 10ms)
    {
        RunUntil(now);
        highest = std::max(highest, Rate());
    }
    EXPECT_GE(highest, 0.5 * Carries);
    EXPECT_LE(highest, 1.6 * Carries);
}

// 100 bytes each two seconds, then ten datagrams at once, on a channel of 10 kB a second. Both peers report
// each one.
TEST_F(CapacityEstimateTest, ABurstOfWhoWasNearlySilentTellsWhatWasCarriedOfTheBurst)
{
    Duration free = 0ns;
    std::map<Duration, Duration> delays;  // by arrival
    const auto send = [&](std::size_t bytes, Duration now)
    {
        Estimate.Sent(bytes, now);
        free = std::max(free, now) + Duration(std::llround(static_cast<double>(bytes) / Carries * 1e9));
        delays[free] = free - now;
    };
    const auto report = [&](Duration until)
    {
        for (; !delays.empty() && delays.begin()->first <= until; delays.erase(delays.begin()))
        {
            const auto &[arrival, delay] = *delays.begin();
            Estimate.Reported(0, delay, arrival, arrival);
            Estimate.Reported(1, delay, arrival, arrival);
        }
    };
    for (auto now = 0s; now < 6s; now += 2s)
    {
        report(now);
        send(100, now);
    }
    for (int i = 0; i < 10; ++i)
    {
        send(1000, 6s);
    }
    for (auto now = 6s + 0ms; now < 8s; now += 200ms)
    {
        report(now);
        send(100, now);
    }
    const std::optional<double> rate = Estimate.Rate(8s);
    EXPECT_TRUE(!rate || *rate >= 0.6 * Carries) << *rate;
}

// A queue before a pause and one after it are two queues.
TEST_F(CapacityEstimateTest, APauseBetweenTwoQueuesSaysNothingOfWhatIsCarried)
{
    Offered = 10.5e3;
    RunUntil(2s);
    EXPECT_FALSE(Estimate.Rate(2s));
    Offered = 0.0;
    Reports = [](Duration) { return false; };
    RunUntil(6s);
    Offered = 12e3;
    Reports = [](Duration) { return true; };
    double least = 1e9;
    for (Duration now = 6s; now < 12s; now += 100ms)
    {
        RunUntil(now);
        least = std::min(least, Estimate.Rate(now).value_or(1e9));
    }
    EXPECT_LT(least, 1e9);
    EXPECT_GE(least, 0.5 * Carries);
}

TEST_F(CapacityEstimateTest, WhatIsForgottenLimitsNoMoreUntilPeersAgreeAnew)
{
    RunUntil(5s);
    ASSERT_GT(Rate(), 0.0);
    Estimate.Forget();
    EXPECT_FALSE(Estimate.Rate(5s));
    Backlog = 0.0;
    Offered = 1e3;
    RunUntil(10s);
    EXPECT_FALSE(Estimate.Rate(10s));
    Offered = 100e3;
    RunUntil(15s);
    EXPECT_TRUE(Estimate.Rate(15s));
}

TEST_F(CapacityEstimateTest, FindsWhatTheRadioCarriesAndKeepsTheQueueShort)
{
    RunUntil(30s);
    const double before = Carried;
    LongestQueue = 0.0;
    RunUntil(90s);
    EXPECT_GE(Carried - before, 0.9 * 60 * Carries);
    EXPECT_LE(LongestQueue, 0.3);
}

TEST_F(CapacityEstimateTest, FallsWhileTheDelayIsAboveTheGoalAndRisesBelow)
{
    RunUntil(30s);
    const double before = Rate();
    Estimate.Reported(0, 200ms, 30s, 30s);
    Estimate.Reported(1, 200ms, 30s, 30s);
    const double late = Rate();
    EXPECT_LT(late, 0.8 * before);
    Estimate.Reported(0, 0ms, 30001ms, 30001ms);
    Estimate.Reported(1, 0ms, 30001ms, 30001ms);
    EXPECT_GT(Rate(), late);
}

TEST_F(CapacityEstimateTest, ALongQueueIsEmptiedBeforeMoreThanTheFloorIsSent)
{
    RunUntil(30s);
    for (int i = 0; i < 3; ++i)
    {
        Estimate.Reported(0, 1500ms, 30s + i * 1ms, 30s + i * 1ms);
        Estimate.Reported(1, 1500ms, 30s + i * 1ms, 30s + i * 1ms);
    }
    EXPECT_EQ(Estimate.Rate(30002ms), CapacityEstimate::Floor);
    EXPECT_EQ(Estimate.Rate(31000ms), CapacityEstimate::Floor);
    EXPECT_GT(Estimate.Rate(31900ms), CapacityEstimate::Floor);
}

TEST_F(CapacityEstimateTest, FollowsARadioThatFallsToATenth)
{
    Carries = 60e3;
    RunUntil(40s);
    Carries = 6e3;
    RunUntil(47s);
    LongestQueue = 0.0;
    const double before = Carried;
    RunUntil(80s);
    EXPECT_LE(LongestQueue, 0.4);
    EXPECT_GE(Carried - before, 0.7 * 33 * Carries);
}

TEST_F(CapacityEstimateTest, RisesGentlyAndAfterAQuietTimeQuickly)
{
    RunUntil(40s);
    const double before = Rate();
    Carries = 1e6;
    RunUntil(42s);
    const double gently = Rate();
    EXPECT_LE(gently, 1.35 * before);
    RunUntil(50s);
    EXPECT_GE(Rate(), 4.0 * before);
}

TEST_F(CapacityEstimateTest, ARateThatIsNotUsedDoesNotRise)
{
    RunUntil(40s);
    Offered = 6000.0;
    RunUntil(42s);
    const double before = Rate();
    RunUntil(55s);
    EXPECT_LE(Rate(), 1.1 * before);
}

TEST_F(CapacityEstimateTest, ALimitThatIsNotUsedDoublesBeforeItGoes)
{
    RunUntil(40s);
    Offered = 2000.0;
    RunUntil(55s);
    const double before = Rate();
    RunUntil(65s);
    EXPECT_GE(Rate(), 1.8 * before);
    EXPECT_LE(Rate(), 2.2 * before);
    RunUntil(85s);
    EXPECT_GE(Rate(), 3.6 * before);
    EXPECT_LE(Rate(), 4.4 * before);
}

TEST_F(CapacityEstimateTest, IsUnlimitedAgainWhenItWasNotUsedForLong)
{
    RunUntil(40s);
    Offered = 2000.0;
    RunUntil(110s);
    EXPECT_FALSE(Estimate.Rate(110s));
}

TEST_F(CapacityEstimateTest, ALimitThatWasUsedBetweenTwoRestsStays)
{
    RunUntil(40s);
    Offered = 500.0;
    RunUntil(85s);
    ASSERT_TRUE(Estimate.Rate(85s));
    Offered = 100e3;
    Carries = 1e6;
    RunUntil(95s);
    Offered = 500.0;
    RunUntil(125s);
    EXPECT_TRUE(Estimate.Rate(125s));
}

TEST_F(CapacityEstimateTest, MuchThatComesAfterALongRestMakesNoLongQueue)
{
    RunUntil(40s);
    Offered = 500.0;
    RunUntil(70s);
    LongestQueue = 0.0;
    Offered = 100e3;
    RunUntil(72s);
    EXPECT_LE(LongestQueue, 0.8);
}

TEST_F(CapacityEstimateTest, ALimitThatIsUsedStays)
{
    RunUntil(300s);
    EXPECT_TRUE(Estimate.Rate(300s));
}

TEST_F(CapacityEstimateTest, NeverGoesBelowTheFloor)
{
    Carries = 50.0;
    RunUntil(120s);
    EXPECT_GE(Rate(), CapacityEstimate::Floor);
}

TEST_F(CapacityEstimateTest, FallsCautiouslyWithoutReportsAndNotBelowHalf)
{
    RunUntil(40s);
    const double before = Rate();
    Reports = [](Duration) { return false; };
    RunUntil(43s);
    EXPECT_GE(Rate(), 0.9 * before);
    RunUntil(47s);
    EXPECT_LE(Rate(), 0.8 * before);
    RunUntil(300s);
    EXPECT_GE(Rate(), 0.45 * before);
    EXPECT_LE(Rate(), 0.6 * before);
}

TEST_F(CapacityEstimateTest, WhereNobodySaysAnyMoreThatSomethingIsLateAUsedRateDoublesEachSecond)
{
    RunUntil(20s);
    Carries = 1e6;
    RunUntil(22s);
    Reports = [](Duration) { return false; };
    const double before = Rate();
    for (Duration now = 22s; now < 29s; now += 500ms)
    {
        RunUntil(now);
        Estimate.NothingLate(0, now, now);
    }
    EXPECT_GE(Rate(), 4.0 * before);
}

// On a channel that is just full, most beats carry no report.
TEST_F(CapacityEstimateTest, SoonAfterADelayBeatsWithoutAReportAreNoNews)
{
    RunUntil(20s);
    Reports = [](Duration) { return false; };
    Estimate.Reported(0, 50ms, 20s, 20s);
    Estimate.Reported(0, 10ms, 20s, 20s);
    const double before = Rate();
    for (Duration now = 20s; now < 23s; now += 500ms)
    {
        RunUntil(now);
        Estimate.NothingLate(0, now, now);
    }
    EXPECT_LE(Rate(), 1.1 * before);
}

TEST_F(CapacityEstimateTest, SilenceAfterALateDatagramIsNoGoodNews)
{
    RunUntil(20s);
    Estimate.Reported(0, 200ms, 20s, 20s);
    Estimate.Reported(1, 200ms, 20s, 20s);
    Reports = [](Duration) { return false; };
    const double before = Rate();
    for (Duration now = 20s; now < 30s; now += 500ms)
    {
        RunUntil(now);
        Estimate.NothingLate(0, now, now);
        Estimate.NothingLate(1, now, now);
    }
    EXPECT_LE(Rate(), 1.1 * before);
}

TEST_F(CapacityEstimateTest, HoldsWithAFifthOfTheReportsLost)
{
    int count = 0;
    Reports = [&count](Duration) { return ++count % 5 != 0; };
    RunUntil(30s);
    const double before = Carried;
    LongestQueue = 0.0;
    RunUntil(90s);
    EXPECT_GE(Carried - before, 0.85 * 60 * Carries);
    EXPECT_LE(LongestQueue, 0.35);
}

TEST_F(CapacityEstimateTest, TheQueueIsWhatWasSentSinceAReportAndNotCarried)
{
    RunUntil(40s);
    Estimate.Reported(0, 100ms, 40s, 40s);
    Estimate.Reported(1, 100ms, 40s, 40s);
    const double carried = 10e3;
    const double before = Seconds(Estimate.Queue(40s));
    EXPECT_NEAR(Seconds(Estimate.Queue(40050ms)), std::max(before - 0.05, 0.0), 0.001);
    Estimate.Sent(1000, 40050ms);
    Estimate.Sent(1, 40060ms);
    EXPECT_NEAR(Seconds(Estimate.Queue(40060ms)), before - 0.06 + 1000 / carried, 0.04);
}

// A message of 13 kB goes at once, over a radio of 30 kB/s, and the peer reports four of its datagrams.
// Between two of them an unknown part of the burst went, and that part is not nothing.
TEST_F(CapacityEstimateTest, BetweenTwoDatagramsOfOneBurstNothingIsMeasured)
{
    for (Duration now = 0s; now < 8s; now += 100ms)
    {
        Estimate.Sent(100, now);
        if (now % 2s == 0s)
        {
            Estimate.Reported(0, 2ms, now, now + 400ms);
        }
    }
    Estimate.Sent(13000, 8s);
    struct Late
    {
        Duration Delay;
        Duration CameAt;
    };
    for (const Late &late :
         {Late{83ms, 8113ms}, Late{171ms, 8205ms}, Late{301ms, 8554ms}, Late{475ms, 8713ms}})
    {
        Estimate.Reported(0, late.Delay, 8s + late.Delay, late.CameAt);
    }
    EXPECT_GE(Estimate.Rate(9s).value_or(1e9), 10e3);
}

// Nodes that meet on a full radio: nobody has reported yet, but what others send comes late here.
TEST_F(CapacityEstimateTest, WithoutReportsTheLatenessOfOthersLimitsTheNode)
{
    Estimate.HeardLate(150ms, 0s, 1s);
    const double slightly = Estimate.Rate(1s).value_or(1e9);
    EXPECT_LE(slightly, CapacityEstimate::FirstRate);
    Estimate.HeardLate(400ms, 0s, 1s);
    EXPECT_LT(Estimate.Rate(1s).value_or(1e9), slightly);
    Estimate.HeardLate(10s, 0s, 1s);
    EXPECT_EQ(Estimate.Rate(1s), CapacityEstimate::Floor);
}

// A radio has become slow, and its queues are full of what was sent before: reports wait in them, too.
TEST_F(CapacityEstimateTest, WhenAllDatagramsOfOthersComeVeryLateTheNodeDoesNotWaitForReports)
{
    Estimate.Reported(0, 5ms, 900ms, 1s);
    Estimate.HeardLate(0s, CapacityEstimate::LongWait, 2s);
    EXPECT_FALSE(Estimate.Rate(2s));
    Estimate.HeardLate(0s, CapacityEstimate::LongWait + 1ms, 3s);
    EXPECT_EQ(Estimate.Rate(3s), CapacityEstimate::Floor);
    Estimate.HeardLate(0s, 20ms, 4s);
    EXPECT_FALSE(Estimate.Rate(4s));
}

// Only the way from the others is slow.
TEST_F(CapacityEstimateTest, APeerThatSaysLaterThatNothingIsLateCountsMoreThanTheLatenessOfOthers)
{
    Estimate.HeardLate(0s, 0s, 2s);
    Estimate.HeardLate(0s, 3s, 3s);
    Estimate.NothingLate(0, 1s, 4s);
    EXPECT_TRUE(Estimate.Rate(4s)) << "that was said before";
    Estimate.NothingLate(0, 2s, 5s);
    EXPECT_FALSE(Estimate.Rate(5s));
}

TEST_F(CapacityEstimateTest, OthersThatComeInTimeDoNotLimitTheNode)
{
    Estimate.HeardLate(CapacityEstimate::Target, 0s, 1s);
    EXPECT_FALSE(Estimate.Rate(1s));
}

TEST_F(CapacityEstimateTest, ReportsOfTheOwnDatagramsCountMoreThanTheLatenessOfOthers)
{
    Estimate.HeardLate(400ms, 0s, 1s);
    Estimate.Reported(0, 5ms, 900ms, 1s);
    EXPECT_FALSE(Estimate.Rate(1s));
    Estimate.Forget();
    EXPECT_FALSE(Estimate.Rate(1h));
}

}  // namespace
}  // namespace Rabit
