#include "Schedule.h"

#include <gtest/gtest.h>

namespace
{
using namespace std::chrono_literals;
using Swarm::Schedule;

TEST(Schedule, BeatsAtTheFirstCallAndThenOncePerPeriod)
{
    Schedule schedule(100ms);
    EXPECT_TRUE(schedule.Due(1000ms));
    EXPECT_FALSE(schedule.Due(1000ms));
    EXPECT_FALSE(schedule.Due(1099ms));
    EXPECT_TRUE(schedule.Due(1100ms));
    EXPECT_FALSE(schedule.Due(1199ms));
}

TEST(Schedule, DoesNotAddUpLateness)
{
    Schedule schedule(100ms);
    schedule.Due(0ms);
    int beats = 0;
    // Looks 7 ms after each deadline.
    for (auto now = 107ms; now < 10'000ms; now += 100ms)
        beats += schedule.Due(now) ? 1 : 0;
    EXPECT_EQ(beats, 99);
    EXPECT_EQ(schedule.DelayMSec(9'990ms), 10);
}

TEST(Schedule, LeavesOutBeatsThatWereSleptThrough)
{
    Schedule schedule(100ms);
    schedule.Due(0ms);
    EXPECT_TRUE(schedule.Due(1'050ms));
    EXPECT_FALSE(schedule.Due(1'060ms));
    EXPECT_EQ(schedule.DelayMSec(1'060ms), 40);
}

TEST(Schedule, RoundsTheDelayUpSoThatTheBeatIsDueAfterIt)
{
    Schedule schedule(100ms);
    schedule.Due(0ms);
    EXPECT_EQ(schedule.DelayMSec(99'100us), 1);
    EXPECT_EQ(schedule.DelayMSec(100ms), 0);
    EXPECT_EQ(schedule.DelayMSec(120ms), 0);
}

TEST(Schedule, IsDueBeforeTheFirstCall)
{
    EXPECT_EQ(Schedule(100ms).DelayMSec(5s), 0);
}

}  // namespace
