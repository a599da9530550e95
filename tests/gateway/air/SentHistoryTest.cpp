#include "air/SentHistory.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(SentHistory, NothingWasSentAtTheBeginning)
{
    EXPECT_EQ(SentHistory().Between(0s, 10s), 0.0);
}

TEST(SentHistory, CountsWhatWasSentBetweenTwoTimes)
{
    SentHistory sent;
    for (auto now = 0ms; now < 10s; now += 5ms)
    {
        sent.Add(50, now);
    }
    EXPECT_NEAR(sent.Between(2s, 3s), 10'000.0, 250.0);
    EXPECT_NEAR(sent.Between(2s, 2100ms), 1000.0, 250.0);
    EXPECT_EQ(sent.Between(3s, 2s), 0.0);
    EXPECT_EQ(sent.Between(-5s, 20s), 100'000.0);
}

TEST(SentHistory, WhatWasSentInABurstIsNotSpreadOverThePauseBehindIt)
{
    SentHistory sent;
    sent.Add(1000, 1s);
    sent.Add(1000, 5s);
    EXPECT_EQ(sent.Between(1100ms, 4900ms), 0.0);
    EXPECT_EQ(sent.Between(900ms, 1100ms), 1000.0);
}

TEST(SentHistory, ABurstBehindAPauseWasCarriedSinceItBegan)
{
    SentHistory sent;
    sent.Add(100, 1s);
    sent.Add(5000, 3s);
    sent.Add(5000, 3100ms);
    EXPECT_NEAR(sent.CarriedAtLeast(1s, 3200ms, 4s), 10'000.0, 1.0);
    EXPECT_NEAR(sent.CarriedAtLeast(3050ms, 3200ms, 4s), 5000.0 / 0.9, 1.0);
    EXPECT_EQ(sent.CarriedAtLeast(3300ms, 3500ms, 4s), 0.0);
    EXPECT_EQ(sent.CarriedAtLeast(3s, 2s, 4s), 0.0);
}

TEST(SentHistory, WhatIsAlwaysSentWasCarriedFromTheFirst)
{
    SentHistory sent;
    for (auto now = 0ms; now < 10s; now += 5ms)
    {
        sent.Add(50, now);
    }
    EXPECT_NEAR(sent.CarriedAtLeast(2s, 4s, 5s), 20'000.0 / 3.0, 100.0);
}

TEST(SentHistory, APauseIsTheLongestTimeWithoutADatagram)
{
    SentHistory sent;
    sent.Add(100, 1s);
    sent.Add(100, 1100ms);
    sent.Add(100, 1600ms);
    sent.Add(100, 1700ms);
    EXPECT_NEAR(std::chrono::duration<double>(sent.LongestPause(1s, 1700ms)).count(), 0.5, 0.04);
    EXPECT_NEAR(std::chrono::duration<double>(sent.LongestPause(1s, 1150ms)).count(), 0.1, 0.04);
    EXPECT_NEAR(std::chrono::duration<double>(sent.LongestPause(1650ms, 2700ms)).count(), 1.0, 0.04);
}

TEST(SentHistory, TwentySecondsAreRemembered)
{
    SentHistory sent;
    for (auto now = 0ms; now < 100s; now += 1ms)
    {
        sent.Add(1, now);
    }
    EXPECT_NEAR(sent.Between(80s, 90s), 10'000.0, 30.0);
    EXPECT_LE(sent.Between(0s, 100s), 21'000.0);
}

}  // namespace
}  // namespace Rabit
