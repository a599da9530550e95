#include <rabit/ManualClock.h>
#include <rabit/RabitClock.h>
#include <rabit/SystemTimeClock.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

namespace
{

using namespace Rabit;
using namespace std::chrono_literals;
using std::chrono::system_clock;

TEST(ManualClock, MovesOnlyWhenItIsTold)
{
    ManualClock clock(100.0, 5s);
    EXPECT_EQ(clock.Monotonic(), 5s);
    EXPECT_EQ(clock.GpsTimeSeconds(), 100.0);
    clock.Advance(1500ms);
    EXPECT_EQ(clock.Monotonic(), 6500ms);
    EXPECT_EQ(clock.GpsTimeSeconds(), 101.5);
    clock.AdvanceTo(6s);  // the past
    EXPECT_EQ(clock.Monotonic(), 6500ms);
    clock.AdvanceTo(8s);
    EXPECT_EQ(clock.GpsTimeSeconds(), 103.0);
    EXPECT_THROW(clock.Advance(-1ns), std::invalid_argument);
}

TEST(ManualClock, AStepOfTheWallClockDoesNotTouchTheMonotonicOne)
{
    ManualClock clock(100.0, 5s);
    clock.SetGpsTimeSeconds(50.0);
    EXPECT_EQ(clock.Monotonic(), 5s);
    EXPECT_EQ(clock.Now().GpsTimeSeconds, 50.0);
    clock.Advance(1s);
    EXPECT_EQ(clock.GpsTimeSeconds(), 51.0);
}

// Puts the offsets back as they were.
class SystemClockTest : public testing::Test
{
protected:
    ~SystemClockTest() override
    {
        Clock.SetLeapSecondOffset(18.0);
        Clock.SetTimeSyncOffset(0.0);
    }
    SystemTimeClock &Clock = *SystemTimeClock::GetSystemTimeClock();
};

TEST_F(SystemClockTest, AgreesWithTheClocksOfTheComputer)
{
    const double before = Clock.ConvertTimePointToGpsTimeInSeconds(system_clock::now());
    const double now = Clock.GetCurrentGpsTimeInSeconds();
    const double after = Clock.ConvertTimePointToGpsTimeInSeconds(system_clock::now());
    EXPECT_GE(now, before - 0.02);
    EXPECT_LE(now, after + 0.02);
    const auto monotonic = std::chrono::steady_clock::now().time_since_epoch();
    EXPECT_GE(Clock.Now().Monotonic, monotonic);
}

TEST_F(SystemClockTest, DoesNotGoBackFromReadingToReading)
{
    std::chrono::nanoseconds last{0};
    for (int i = 0; i < 200000; ++i)
    {
        const std::chrono::nanoseconds now = Clock.Now().GpsTime;
        // A new measurement of the wall clock may set the time back by at most its uncertainty.
        ASSERT_GT(now, last - 1ms);
        ASSERT_NE(now, last);
        last = now;
    }
}

TEST(RabitClock, ASecondsDoubleIsTheNearestOfItsNanoseconds)
{
    EXPECT_EQ(RabitClock::ToSeconds(0ns), 0.0);
    EXPECT_EQ(RabitClock::ToSeconds(1500ms), 1.5);
    EXPECT_EQ(RabitClock::ToSeconds(1400000000250000000ns), 1400000000.25);
    EXPECT_EQ(RabitClock::ToSeconds(1400000000250000100ns), 1400000000.25);
    EXPECT_EQ(RabitClock::ToSeconds(-1500ms), -1.5);
}

TEST(RabitClock, SecondsOfTodayComeBackFromTheirNanoseconds)
{
    double seconds = 1.48e9;
    for (int i = 0; i < 1000; ++i)
    {
        ASSERT_EQ(RabitClock::ToSeconds(RabitClock::ToNanoseconds(seconds)), seconds);
        seconds = std::nextafter(seconds, 2e9);
    }
}

TEST(RabitClock, SecondsBeyondAllCalendarsBecomeTheNearestBoundOfNanoseconds)
{
    EXPECT_EQ(RabitClock::ToNanoseconds(1e300), 9000000000s);
    EXPECT_EQ(RabitClock::ToNanoseconds(-1e300), -9000000000s);
    EXPECT_EQ(RabitClock::ToNanoseconds(std::numeric_limits<double>::quiet_NaN()), 0ns);
}

TEST_F(SystemClockTest, OffsetsTakeEffectAtOnce)
{
    const double utc = Clock.GetCurrentUTCTimeInSeconds();
    EXPECT_NEAR(Clock.GetCurrentGpsTimeInSeconds() - utc, 18.0, 5.0);
    Clock.SetTimeSyncOffset(1e6);
    EXPECT_NEAR(Clock.GetCurrentUTCTimeInSeconds() - utc, 1e6, 100.0);
    Clock.SetTimeSyncOffset(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(Clock.GetTimeSyncOffset(), 1e6);
}

TEST_F(SystemClockTest, TheLeapSecondOffsetIsAWholeNumberFrom0To100)
{
    EXPECT_EQ(Clock.GetLeapSecondOffset(), 18.0);  // since 2017-01-01
    Clock.SetLeapSecondOffset(19.9);
    EXPECT_EQ(Clock.GetLeapSecondOffset(), 19.0);
    Clock.SetLeapSecondOffset(-1.0);
    EXPECT_EQ(Clock.GetLeapSecondOffset(), 0.0);
    Clock.SetLeapSecondOffset(1000.0);
    EXPECT_EQ(Clock.GetLeapSecondOffset(), 100.0);
}

TEST_F(SystemClockTest, ConvertsTimePointsBothWays)
{
    const system_clock::time_point gpsEpoch{std::chrono::seconds(SystemTimeClock::GpsEpochUnixSeconds)};
    EXPECT_EQ(Clock.ConvertTimePointToGpsTimeInSeconds(gpsEpoch), 18.0);
    EXPECT_EQ(Clock.ConvertTimePointToGpsTimeInSecondsMethod2Resolution1Second(gpsEpoch + 1999ms), 19.0);
    EXPECT_EQ(Clock.GpsTimeSecondsToSystemClockTimepoint(18.0), gpsEpoch);
    const system_clock::time_point now = system_clock::now();
    const auto back =
        Clock.GpsTimeSecondsToSystemClockTimepoint(Clock.ConvertTimePointToGpsTimeInSeconds(now));
    EXPECT_LT(std::chrono::abs(back - now), 1us);
}

TEST_F(SystemClockTest, WritesCalendarTimes)
{
    // 2016-12-25T13:30:15 UTC, written down as 1482672615 Unix seconds.
    const double gps = 1482672615.0 - 315964800.0 + 18.0;
    EXPECT_EQ(Clock.GetUTCTimeStringFromGpsTimeStamp(gps + 0.9), "2016-12-25T13:30:15");
    const std::tm utc = Clock.GetUTCTimeStructFromGpsTimeStamp(gps);
    EXPECT_EQ(utc.tm_year, 116);
    EXPECT_EQ(utc.tm_hour, 13);
    EXPECT_EQ(Clock.ToUTCSeconds(&utc), 1482672615s);
    EXPECT_EQ(Clock.DurationSecondsFromUTCEpoc(2016, 12, 25, 13, 30, 15), 1482672615s);
    EXPECT_EQ(Clock.DurationSecondsFromUTCEpoc(1980, 1, 6, 0, 0), 315964800s);
    EXPECT_EQ(Clock.clockTimepointAsString(system_clock::time_point(1482672615s)), "2016-12-25T13:30:15");
}

TEST_F(SystemClockTest, WritesLocalTimes)
{
    const char *const former = std::getenv("TZ");  // NOLINT(concurrency-mt-unsafe): no other threads here
    const std::string kept = former != nullptr ? former : "";
    setenv("TZ", "EST5", 1);
    tzset();
    EXPECT_EQ(Clock.GetLocalTimeStringFromGpsTimeStamp(1482672615.0 - 315964800.0 + 18.0),
              "2016-12-25T08:30:15");
    EXPECT_EQ(Clock.GetLocalTimeStructFromGpsTimeStamp(1482672615.0 - 315964800.0 + 18.0).tm_hour, 8);
    former != nullptr ? setenv("TZ", kept.c_str(), 1) : unsetenv("TZ");
    tzset();
}

TEST_F(SystemClockTest, TimesThatAreNoDatesDoNoHarm)
{
    for (const double stamp :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity(), 1e300, -1e300})
    {
        EXPECT_EQ(Clock.GetUTCTimeStringFromGpsTimeStamp(stamp), "1970-01-01T00:00:00");
        Clock.GpsTimeSecondsToSystemClockTimepoint(stamp);
    }
}

TEST(RabitClock, TheSystemsReadsBothClocksAtOneMoment)
{
    const RabitClock &clock = *RabitClock::System();
    const auto before = clock.Monotonic();
    const PostTime now = clock.Now();
    EXPECT_GE(now.Monotonic, before);
    EXPECT_LE(now.Monotonic, clock.Monotonic());
    EXPECT_GE(clock.GpsTimeSeconds(), now.GpsTimeSeconds - 1e-3);
}

}  // namespace
