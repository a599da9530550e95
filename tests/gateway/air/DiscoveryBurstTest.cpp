#include "air/DiscoveryBurst.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(DiscoveryBurst, IsOverAfterASecondInWhichLittleIsSaid)
{
    DiscoveryBurst burst;
    EXPECT_FALSE(burst.IsOverAfter(1000, 100ms));
    EXPECT_FALSE(burst.IsOverAfter(1000, 900ms));
    EXPECT_FALSE(burst.IsOverAfter(0, 1000ms));
    EXPECT_FALSE(burst.IsOverAfter(300, 1900ms));
    EXPECT_TRUE(burst.IsOverAfter(0, 2000ms));
}

TEST(DiscoveryBurst, IsSaidToBeOverOnce)
{
    DiscoveryBurst burst;
    burst.IsOverAfter(5000, 0ms);
    burst.IsOverAfter(0, 1000ms);
    EXPECT_TRUE(burst.IsOverAfter(0, 2000ms));
    EXPECT_FALSE(burst.IsOverAfter(0, 3000ms));
}

TEST(DiscoveryBurst, LastsAsLongAsMuchIsSaid)
{
    DiscoveryBurst burst;
    for (int second = 0; second < 20; ++second)
    {
        EXPECT_FALSE(burst.IsOverAfter(1600, second * 1s));
    }
    EXPECT_FALSE(burst.IsOverAfter(400, 20s));
    EXPECT_TRUE(burst.IsOverAfter(399, 21s));
}

TEST(DiscoveryBurst, IsNotWhatParticipantsSayNowAndThen)
{
    DiscoveryBurst burst;
    for (int second = 0; second < 100; ++second)
    {
        EXPECT_FALSE(burst.IsOverAfter(second % 10 == 0 ? 1000 : 0, second * 1s));
    }
}

}  // namespace
}  // namespace Rabit
