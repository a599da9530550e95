#pragma once

#include <rabit/RabitClock.h>
#include <rabit/UptimeClock.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <mutex>
#include <string>

namespace Rabit
{

// The wall clock of this computer in GPS and UTC seconds, and conversions between them, calendar time and
// std::chrono. Both count from 1980-01-06T00:00:00; GPS seconds are ahead of UTC seconds by the leap second
// offset. One object for the process. All methods may be called from any thread.
//
// The current time is computed from the UptimeClock and the offset to the wall clock. The offset is
// measured anew when the last measurement is 10 ms old: a step of the wall clock shows within that time,
// and is logged as a warning if it is 1 ms or more.
//
// Leap seconds: 18, which holds since 2017-01-01 and until the IERS announces another in its Bulletin C.
// After a change a program calls SetLeapSecondOffset before it makes its first message. All nodes that
// exchange time stamps should be set alike.
class SystemTimeClock
{
public:
    // Seconds from 1970-01-01 to 1980-01-06.
    static constexpr std::int64_t GpsEpochUnixSeconds = 315964800;

    static SystemTimeClock *GetSystemTimeClock();
    SystemTimeClock(const SystemTimeClock &) = delete;
    SystemTimeClock &operator=(const SystemTimeClock &) = delete;

    // Measures the distance to the wall clock now, for a program that has just set the wall clock.
    void SetGpsTimeOffset();
    // GPS minus UTC in seconds; 18 unless set.
    double GetLeapSecondOffset();
    // Whole seconds from 0 to 100: a fraction is cut off, other values become the nearest bound. Takes effect
    // at once. NaN is ignored.
    void SetLeapSecondOffset(double seconds);
    // Seconds that are added to the current time, to agree with a better clock; 0 unless set.
    double GetTimeSyncOffset();
    // Takes effect at once. A value that is not finite is ignored; one beyond +/- 5e9 becomes the nearest
    // bound.
    void SetTimeSyncOffset(double seconds);

    // MaxAhead: how far a time stamp may run ahead of the clock. LeastStepBack: up to here a backward step of
    // the wall clock is bridged, beyond it is followed.
    static constexpr std::chrono::nanoseconds MaxAhead{2000};
    static constexpr std::chrono::nanoseconds LeastStepBack{10000};

    // The current time: both clocks at one moment, for one clock read.
    //
    // Of two consecutive readings of one thread, the second is later, by 1 ns at least (PostTime::GpsTime).
    // As doubles (GpsTimeSeconds) both may be equal, because doubles are 238 ns apart. A wall clock that is
    // set back by more than LeastStepBack is followed. If a smaller step puts readings ahead of it by more
    // than MaxAhead, a reading waits for the clock.
    PostTime Now();
    // The same as a double, which may be equal to the last one.
    double GetCurrentGpsTimeInSeconds();
    double GetCurrentUTCTimeInSeconds();

    // Logs that the wall clock was set, if that was not logged yet. Posts and managers call it, because
    // reading the time itself must not call the log. The caller must hold no lock.
    void ReportSteps()
    {
        if (_stepNotReported.load(std::memory_order_relaxed) != 0)
        {
            WriteSteps();
        }
    }

    // GPS seconds of a time point of the system clock. The sync offset is not part of conversions.
    double ConvertTimePointToGpsTimeInSeconds(std::chrono::system_clock::time_point timePoint);
    // The same with the fraction of a second cut off.
    double ConvertTimePointToGpsTimeInSecondsMethod2Resolution1Second(
        std::chrono::system_clock::time_point timePoint);
    // The inverse of ConvertTimePointToGpsTimeInSeconds, to within the resolution of a double (about 0.2 us).
    std::chrono::system_clock::time_point GpsTimeSecondsToSystemClockTimepoint(double gpsTimeSeconds);

    // Calendar time of a time stamp; fractions of a second are cut off. A time stamp outside the calendar's
    // range (NaN, infinite, beyond the year 9999 or before the year 0) gives that of 1970-01-01.
    std::tm GetUTCTimeStructFromGpsTimeStamp(double gpsTimeSeconds);
    std::tm GetLocalTimeStructFromGpsTimeStamp(double gpsTimeSeconds);
    // As YYYY-MM-DDTHH:MM:SS (ISO 8601).
    std::string GetUTCTimeStringFromGpsTimeStamp(double gpsTimeSeconds);
    std::string GetLocalTimeStringFromGpsTimeStamp(double gpsTimeSeconds);

    // Seconds from 1970-01-01 to a UTC date (month 1 to 12, day 1 to 31).
    std::chrono::seconds DurationSecondsFromUTCEpoc(int year, int mon, int day, int hour, int min,
                                                    int sec = 0);
    // The same for a broken-down UTC time. Fields out of range carry over, as in POSIX mktime.
    std::chrono::seconds ToUTCSeconds(const std::tm *utc);
    // UTC as YYYY-MM-DDTHH:MM:SS.
    std::string clockTimepointAsString(const std::chrono::system_clock::time_point &timePoint);
    // Prints resolution and steadiness of the standard clocks to stdout.
    void printSystemClockCharacteristics();

private:
    // Age in nanoseconds at which the offset between the two clocks is measured anew.
    static constexpr std::int64_t MeasurementLifetime = 10000000;

    // The least step of the wall clock, in nanoseconds, that is logged.
    static constexpr std::int64_t LeastStepReported = 1000000;

    // The last time stamp that a thread got, and the clock reading behind it.
    struct LastOfThread
    {
        std::chrono::nanoseconds Given;
        std::chrono::nanoseconds Reading;
    };

    SystemTimeClock();
    PostTime Read();
    PostTime ReadAfterLast();
    void MeasureWallOffset();
    void UpdateAddedSeconds();
    void WriteSteps();

    static inline thread_local LastOfThread _last{};

    std::mutex _mutex;
    double _leapSeconds = 18.0;
    double _syncSeconds = 0.0;
    // Leap plus sync offset: what is added to UTC since 1980 to give GPS time, in nanoseconds.
    std::atomic<std::int64_t> _added{18000000000};
    // Wall clock minus monotonic clock in nanoseconds, and when it was measured by the monotonic clock.
    std::atomic<std::int64_t> _wallOffset{0};
    std::atomic<std::int64_t> _measuredAt{0};
    // Sum of the steps of the wall clock that are not logged yet, in nanoseconds.
    std::atomic<std::int64_t> _stepNotReported{0};
};

// Inline because it is the largest part of a post.
inline PostTime SystemTimeClock::Read()
{
    const std::timespec uptime = UptimeClock::Read();
    const std::chrono::nanoseconds monotonic = UptimeClock::ToTimePoint(uptime).time_since_epoch();
    if (monotonic.count() - _measuredAt.load(std::memory_order_acquire) >= MeasurementLifetime)
    {
        MeasureWallOffset();
    }
    // Whole seconds and nanoseconds are added separately: so the division of the sum, which the double needs,
    // does not wait for the clock.
    constexpr std::int64_t second = 1000000000;
    const std::int64_t offset = _wallOffset.load(std::memory_order_relaxed) - GpsEpochUnixSeconds * second +
                                _added.load(std::memory_order_relaxed);
    std::int64_t seconds = uptime.tv_sec + offset / second;
    std::int64_t nanoseconds = uptime.tv_nsec + offset % second;
    if (nanoseconds >= second)
    {
        ++seconds;
        nanoseconds -= second;
    }
    return PostTime{RabitClock::ToSeconds(seconds, nanoseconds), monotonic,
                    std::chrono::nanoseconds(seconds * second + nanoseconds)};
}

inline PostTime SystemTimeClock::Now()
{
    const PostTime time = Read();
    if (time.GpsTime > _last.Given)
    {
        _last = LastOfThread{time.GpsTime, time.GpsTime};
        return PostTime{time.GpsTimeSeconds, time.Monotonic, time.GpsTime};
    }
    return ReadAfterLast();
}

}  // namespace Rabit
