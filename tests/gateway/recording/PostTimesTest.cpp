#include "recording/replay/PostTimes.h"

#include <gtest/gtest.h>

namespace Rabit::Replay
{
namespace
{

using namespace std::chrono_literals;

TEST(PostTimes, AMessageIsAsOldAsItWas)
{
    PostTimes times(1);
    EXPECT_EQ(times.Of(0, 10s, 3s), 7s);
    EXPECT_EQ(times.Of(0, 11s, 0s), 11s);
    EXPECT_EQ(times.NotKept(), 0U);
}

TEST(PostTimes, NothingIsPostedBeforeWhatCameBeforeOfItsStream)
{
    PostTimes times(2);
    EXPECT_EQ(times.Of(0, 10s, 0s), 10s);
    EXPECT_EQ(times.Of(0, 11s, 60s), 10s + PostTimes::Least) << "a seek backwards restores what is older";
    EXPECT_EQ(times.Of(1, 11s, 60s), -49s) << "of another stream nothing has come";
    EXPECT_EQ(times.NotKept(), 1U);
}

TEST(PostTimes, TwoOfOneMomentAreToldApart)
{
    PostTimes times(1);
    EXPECT_EQ(times.Of(0, 10s, 0s), 10s);
    EXPECT_EQ(times.Of(0, 10s, 0s), 10s + PostTimes::Least);
    EXPECT_EQ(times.NotKept(), 0U) << "that much nobody sees";
}

TEST(PostTimes, InANewLifeOfItsNodeAStreamBeginsAnew)
{
    PostTimes times(1);
    times.Of(0, 10s, 0s);
    times.Forget(0);
    EXPECT_EQ(times.Of(0, 11s, 60s), -49s);
}

TEST(PostTimes, NothingIsPostedInTheFuture)
{
    PostTimes times(1);
    EXPECT_EQ(times.Of(0, 10s, -5s), 10s);
}

}  // namespace
}  // namespace Rabit::Replay
