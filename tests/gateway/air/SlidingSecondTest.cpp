#include "air/SlidingSecond.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(SlidingSecond, WhatWasSentTogetherIsForgottenTogether)
{
    SlidingSecond second;
    second.Add(100, 10, 0ms);
    second.Add(100, 10, 3ms);
    EXPECT_EQ(second.Scheduled(SlidingSecond::Length + 2ms), 200u);
    EXPECT_EQ(second.Unscheduled(SlidingSecond::Length + 2ms), 20u);
    EXPECT_EQ(second.Scheduled(SlidingSecond::Length + 3ms), 0u);
    EXPECT_EQ(second.Unscheduled(SlidingSecond::Length + 3ms), 0u);
}

TEST(SlidingSecond, SaysWhenThereWillBeRoom)
{
    SlidingSecond second;
    second.Add(100, 0, 0ms);
    second.Add(200, 0, 100ms);
    second.Add(300, 0, 200ms);
    const auto below = [&second](std::uint64_t most)
    { return second.When([most](std::uint64_t sent, std::uint64_t) { return sent <= most; }, 300ms); };
    EXPECT_EQ(below(600), 300ms);
    EXPECT_EQ(below(500), SlidingSecond::Length);
    EXPECT_EQ(below(499), SlidingSecond::Length + 100ms);
    EXPECT_EQ(below(0), SlidingSecond::Length + 200ms);
}

TEST(SlidingSecond, MemoryIsBoundedAndSumsAreNotTooLow)
{
    SlidingSecond second;
    for (auto now = 0us; now < 5s; now += 50us)
    {
        second.Add(1, 0, now);
    }
    EXPECT_GE(second.Scheduled(5s), 20'999u);
    EXPECT_LE(second.Scheduled(5s), 21'100u);
}

}  // namespace
}  // namespace Rabit
