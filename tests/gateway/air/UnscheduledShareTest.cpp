#include "air/UnscheduledShare.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(UnscheduledShare, IsTheMostThatWentInASecond)
{
    UnscheduledShare share;
    share.Add(100, 10s);
    share.Add(300, 10500ms);
    share.Add(200, 20s);
    EXPECT_EQ(share.Rate(21s), 400.0);
}

TEST(UnscheduledShare, LastsForHalfAMinuteAtLeast)
{
    UnscheduledShare share;
    share.Add(400, 10s);
    EXPECT_EQ(share.Rate(41s), 400.0);
}

TEST(UnscheduledShare, LastsForALittleMoreThanAMinuteAtMost)
{
    UnscheduledShare share;
    share.Add(400, 10s);
    share.Add(30, 60s);
    EXPECT_EQ(share.Rate(100s), 30.0);
}

TEST(UnscheduledShare, IsNoMoreThanAnAnnouncementOrTheAverage)
{
    UnscheduledShare share;
    share.Add(20000, 10s);
    EXPECT_EQ(share.Rate(12s), 600.0);
    share.Add(15000, 14s);
    EXPECT_EQ(share.Rate(16s), 1000.0);
}

TEST(UnscheduledShare, IsForgottenWhereNothingWentForLong)
{
    UnscheduledShare share;
    share.Add(400, 10s);
    EXPECT_EQ(share.Rate(1000s), 0.0);
}

}  // namespace
}  // namespace Rabit
