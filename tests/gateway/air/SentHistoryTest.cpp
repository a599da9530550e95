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
