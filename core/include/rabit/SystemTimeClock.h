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
// The current time is computed from the UptimeClock and its distance to the wall clock, which is measured
// anew when the last measurement is 10 ms old: a step of the wall clock shows within that time.
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
    // GPS minus UTC in seconds; 17 unless set.
    double GetLeapSecondOffset();
    // Whole seconds from 0 to 100: a fraction is cut off, other values become the nearest bound. Takes effect
    // at once. NaN is ignored.
    void SetLeapSecondOffset(double seconds);
    // Seconds that are added to the current time, to agree with a better clock; 0 unless set.
    double GetTimeSyncOffset();
    // Takes effect at once. A value that is not finite is ignored.
    void SetTimeSyncOffset(double seconds);

    // The current time, both clocks of one moment, for one clock read.
    PostTime Now();
    double GetCurrentGpsTimeInSeconds();
    double GetCurrentUTCTimeInSeconds();

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
    // Age in nanoseconds at which the distance of the two clocks is measured anew.
    static constexpr std::int64_t MeasurementLifetime = 10000000;

    SystemTimeClock();
    void MeasureWallOffset();
    void UpdateAddedSeconds();

    std::mutex _mutex;
    double _leapSeconds = 17.0;
    double _syncSeconds = 0.0;
    // Leap plus sync offset: what is added to UTC since 1980 to give GPS time.
    std::atomic<double> _addedSeconds{17.0};
    // Wall clock minus monotonic clock in nanoseconds, and when it was measured by the monotonic clock.
    std::atomic<std::int64_t> _wallOffset{0};
    std::atomic<std::int64_t> _measuredAt{0};
};

// Inline for the sake of posting, of which it is the largest part.
inline PostTime SystemTimeClock::Now()
{
    const std::chrono::nanoseconds monotonic = UptimeClock::now().time_since_epoch();
    if (monotonic.count() - _measuredAt.load(std::memory_order_acquire) >= MeasurementLifetime)
    {
        MeasureWallOffset();
    }
    const std::int64_t sinceGpsEpoch =
        monotonic.count() + _wallOffset.load(std::memory_order_relaxed) - GpsEpochUnixSeconds * 1000000000;
    return PostTime{static_cast<double>(sinceGpsEpoch) * 1e-9 + _addedSeconds.load(std::memory_order_relaxed),
                    monotonic};
}

}  // namespace Rabit
