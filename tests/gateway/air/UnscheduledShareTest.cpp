#include "air/UnscheduledShare.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(UnscheduledShare, KeepsNothingFreeBetweenAnnouncements)
{
    UnscheduledShare share(30s);
    share.Add(444, 10s, 10s);
    EXPECT_EQ(share.Rate(10s), 0.0);
    EXPECT_EQ(share.Rate(25s), 0.0);
    EXPECT_EQ(share.Rate(38s), 0.0);
}

TEST(UnscheduledShare, KeepsFreeWhatWentAPeriodAgoFromASecondBefore)
{
    UnscheduledShare share(30s);
    share.Add(444, 10s, 10s);
    EXPECT_EQ(share.Rate(38900ms), 444.0);
    EXPECT_EQ(share.Rate(40s), 444.0);
}

TEST(UnscheduledShare, KeepsFreeFromTheEarliestMomentAtWhichItMayHaveBeenSaid)
{
    UnscheduledShare share(30s);
    share.Add(444, 9s, 10s);
    EXPECT_EQ(share.Rate(37900ms), 444.0);
    EXPECT_EQ(share.Rate(40400ms), 444.0);
}

TEST(UnscheduledShare, WaitsALittleForWhatComesLate)
{
    UnscheduledShare share(30s);
    share.Add(444, 10s, 10s);
    EXPECT_EQ(share.Rate(40400ms), 444.0);
    EXPECT_EQ(share.Rate(40600ms), 0.0);
}

TEST(UnscheduledShare, CountsTogetherWhatFallsIntoOneSecond)
{
    UnscheduledShare share(30s);
    share.Add(100, 10s, 10s);
    share.Add(300, 10500ms, 10500ms);
    EXPECT_EQ(share.Rate(40s), 400.0);
}

TEST(UnscheduledShare, ExpectsWhatCameLateFromThenOn)
{
    UnscheduledShare share(30s);
    share.Add(444, 10s, 10s);
    share.Add(444, 40400ms, 40400ms);
    EXPECT_EQ(share.Rate(69100ms), 0.0);
    EXPECT_EQ(share.Rate(70500ms), 444.0);
}

TEST(UnscheduledShare, KeepsNoMoreFreeThanAnAnnouncementAPeriodLater)
{
    UnscheduledShare share(30s);
    share.Add(20000, 10s, 10s);
    EXPECT_EQ(share.Rate(40s), 600.0);
}

TEST(UnscheduledShare, ExpectsAConversationToGoOn)
{
    UnscheduledShare share(30s);
    share.Add(900, 10s, 10s);
    share.Add(700, 11s, 11s);
    EXPECT_EQ(share.Rate(11500ms), 800.0);
    EXPECT_EQ(share.Rate(14s), 0.0);
}

TEST(UnscheduledShare, IsForgottenWhereNothingWentForAPeriod)
{
    UnscheduledShare share(30s);
    share.Add(444, 10s, 10s);
    share.Add(30, 60s, 60s);
    EXPECT_EQ(share.Rate(70s), 0.0);
}

}  // namespace
}  // namespace Rabit
