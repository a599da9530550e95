// Time stamps under a wall clock that is set, and in bursts. This program replaces the system's clocks.
#include "CapturedLog.h"
#include "TestMessages.h"

#include <rabit/PublishSubscribeMessage.h>
#include <rabit/SystemTimeClock.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <ctime>
#include <memory>
#include <string>

namespace
{

// Nanoseconds. Each reading of a clock takes 10 ns, less than on any computer.
constexpr std::int64_t shortestTick = 10;
std::int64_t tick = shortestTick;
std::int64_t uptime = 1000000000;
std::int64_t wallAhead = 1800000000000000000;

}  // namespace

// Replaces the C library's function.
extern "C" int clock_gettime(clockid_t clock, std::timespec *time) noexcept
{
    uptime += tick;
    const std::int64_t now = clock == CLOCK_REALTIME ? uptime + wallAhead : uptime;
    time->tv_sec = now / 1000000000;
    time->tv_nsec = now % 1000000000;
    return 0;
}

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

constexpr std::int64_t Second = 1000000000;
constexpr double OneStep = 2.5e-7;  // of a time stamp, at most

class WallClock : public testing::Test
{
protected:
    WallClock()
    {
        Message.SetGlobalPublishSubscribeMessageRef(
            std::make_shared<PublishSubscribeMessage>(Message.Clone()));
        Pass(Second);
        Message.PostMessage();  // measures the wall clock
    }
    ~WallClock() override { tick = shortestTick; }
    static void Pass(std::int64_t time) { uptime += time; }
    // Returns the correct time stamp of now.
    static double WallTime()
    {
        return Clock().ConvertTimePointToGpsTimeInSeconds(std::chrono::system_clock::now());
    }
    static SystemTimeClock &Clock() { return *SystemTimeClock::GetSystemTimeClock(); }
    double Post()
    {
        Message.PostMessage();
        return Message.GetTimeStamp();
    }

    const CapturedLog Log;
    NumberMessage Message;
};

TEST_F(WallClock, TimeStampsOfAThreadAreNeverEqual)
{
    PostTime last = Clock().Now();
    for (int i = 0; i < 1000; ++i)
    {
        const PostTime next = Clock().Now();
        ASSERT_GT(next.GpsTime, last.GpsTime) << "reading " << i;
        ASSERT_GE(next.GpsTimeSeconds, last.GpsTimeSeconds) << "reading " << i;
        last = next;
    }
}

TEST_F(WallClock, TimeStampsOfAThreadAreNotEqualWhileItStandsStill)
{
    tick = 0;
    const PostTime first = Clock().Now();
    EXPECT_EQ(Clock().Now().GpsTime, first.GpsTime + 1ns);
    EXPECT_EQ(Clock().Now().GpsTime, first.GpsTime + 2ns);
}

TEST_F(WallClock, MessagesThatAThreadMakesOneAfterTheOtherHaveDifferentStamps)
{
    NumberMessage first;
    NumberMessage second;
    EXPECT_FALSE(first.CompareTime(&second));
    first.SetTimeNow();
    second.SetTimeNow();
    EXPECT_FALSE(first.CompareTime(&second));
}

TEST_F(WallClock, ATimeStampThatIsGivenAsADoubleEqualsTheOneItWasTakenFrom)
{
    const NumberMessage first;
    NumberMessage second;
    second.SetTimeStamp(first.GetTimeStamp());
    NumberMessage third = first;
    EXPECT_TRUE(third.CompareTime(&second));
    EXPECT_TRUE(second.CompareTime(&third));
}

TEST_F(WallClock, ASetTimeNowAfterAPostCountsAsNewAtTheNextFetch)
{
    for (int i = 0; i < 100; ++i)  // some of them within one step of a double
    {
        Message.PostMessage();
        Message.SetTimeNow();
        ASSERT_TRUE(Message.FetchMessage()) << "post " << i;
        ASSERT_FALSE(Message.FetchMessage()) << "post " << i;
    }
}

TEST_F(WallClock, ABurstOfPostsReadsItOnceForEachPost)
{
    const std::int64_t before = uptime;
    for (int i = 0; i < 1000; ++i)
    {
        Message.PostMessage();
    }
    EXPECT_EQ(uptime - before, 1000 * tick);
}

TEST_F(WallClock, ABurstOfTimeStampsRunsAheadOfItByTwoMicrosecondsAtMost)
{
    for (int i = 0; i < 1000; ++i)
    {
        const double stamp = Clock().GetCurrentGpsTimeInSeconds();
        ASSERT_LE(stamp, WallTime() + 2e-6 + OneStep) << "reading " << i;
    }
}

TEST_F(WallClock, ABurstOfPostsRunsAheadOfItByFourMicrosecondsAtMost)
{
    NumberMessage last;
    for (int i = 0; i < 1000; ++i)
    {
        const double stamp = Post();
        ASSERT_FALSE(Message.CompareTime(&last)) << "post " << i;
        ASSERT_GE(stamp, last.GetTimeStamp()) << "post " << i;
        ASSERT_LE(stamp, WallTime() + 4e-6 + OneStep) << "post " << i;
        last = Message;
    }
}

TEST_F(WallClock, PostsFollowWhenItIsSetBackAnHour)
{
    wallAhead -= 3600 * Second;
    Pass(Second);
    EXPECT_NEAR(Post(), WallTime(), 1e-3);
    Pass(Second);
    EXPECT_NEAR(Post(), WallTime(), 1e-3);
    EXPECT_NEAR(NumberMessage().GetTimeStamp(), WallTime(), 1e-3);
}

TEST_F(WallClock, PostsAfterItWasSetBackRiseAgain)
{
    wallAhead -= 3600 * Second;
    Pass(Second);
    double last = Post();
    for (int i = 0; i < 100; ++i)
    {
        Pass(1000);
        const double stamp = Post();
        ASSERT_GT(stamp, last) << "post " << i;
        last = stamp;
    }
}

TEST_F(WallClock, TimeStampsDoNotGoBackForAStepOfAFewMicroseconds)
{
    double last = Post();
    for (int i = 0; i < 20; ++i)
    {
        wallAhead -= 5000;
        Clock().SetGpsTimeOffset();
        const double stamp = Post();
        ASSERT_GE(stamp, last) << "step " << i;
        ASSERT_LE(stamp, WallTime() + 4e-6 + OneStep) << "step " << i;
        last = stamp;
    }
}

TEST_F(WallClock, IsSaidToHaveBeenSetWhicheverWay)
{
    const std::size_t before = Log.Lines().size();
    wallAhead -= 3600 * Second;
    Pass(Second);
    Post();
    ASSERT_EQ(Log.Lines().size(), before + 1);
    EXPECT_NE(Log.Lines().back().find("set back by 3600"), std::string::npos) << Log.Lines().back();
    Post();
    wallAhead += Second / 2;
    Pass(Second);
    Post();
    ASSERT_EQ(Log.Lines().size(), before + 2);
    EXPECT_NE(Log.Lines().back().find("set forward by 0.5"), std::string::npos) << Log.Lines().back();
}

TEST_F(WallClock, IsNotSaidToHaveBeenSetForTheInaccuracyOfAMeasurement)
{
    const std::size_t before = Log.Lines().size();
    for (int i = 0; i < 20; ++i)
    {
        wallAhead += (i % 2 == 0) ? 100000 : -100000;
        Pass(Second);
        Post();
    }
    EXPECT_EQ(Log.Lines().size(), before);
}

}  // namespace
