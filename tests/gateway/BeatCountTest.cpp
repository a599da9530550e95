#include "presence/BeatCount.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

TEST(BeatCount, WhatIsMissingBetweenTheFirstAndTheLastDidNotCome)
{
    BeatCount count;
    for (const std::uint64_t number : {7u, 8u, 11u})
    {
        count.Add(number);
    }
    EXPECT_EQ(count.Heard(), 3u);
    EXPECT_EQ(count.Missed(), 2u);
}

TEST(BeatCount, ALeapIsNoLoss)
{
    BeatCount count;
    count.Add(1);
    count.Add(1'000'000);
    count.Add(3);
    count.Add(4);
    EXPECT_EQ(count.Missed(), 0u);
}

}  // namespace
}  // namespace Rabit
