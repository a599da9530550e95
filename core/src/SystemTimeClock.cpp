#include <rabit/SystemTimeClock.h>

#include <rabit/RabitLog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ratio>

namespace Rabit
{
namespace
{

using std::chrono::duration_cast;
using std::chrono::nanoseconds;
using std::chrono::system_clock;

constexpr std::int64_t NanosecondsPerSecond = 1000000000;

std::int64_t UptimeNow()
{
    return duration_cast<nanoseconds>(UptimeClock::now().time_since_epoch()).count();
}

std::int64_t WallNow()
{
    return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

// Whole Unix seconds of a UTC time in seconds since 1980; 0 if it has no calendar date.
std::time_t ToUnixSeconds(double utcSince1980)
{
    constexpr double yearZero = -62167219200.0;
    constexpr double year10000 = 253402300800.0;
    const double unixSeconds =
        std::floor(utcSince1980) + static_cast<double>(SystemTimeClock::GpsEpochUnixSeconds);
    return (unixSeconds >= yearZero && unixSeconds < year10000) ? static_cast<std::time_t>(unixSeconds) : 0;
}

std::string AsIsoString(const std::tm &time)
{
    char text[80];
    std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d", time.tm_year + 1900, time.tm_mon + 1,
                  time.tm_mday, time.tm_hour, time.tm_min, time.tm_sec);
    return text;
}

template <typename Clock>
void PrintCharacteristics(const char *name)
{
    using Period = typename Clock::period;
    std::printf("%s: resolution %g ns, %s\n", name,
                1e9 * static_cast<double>(Period::num) / static_cast<double>(Period::den),
                Clock::is_steady ? "steady" : "not steady");
}

}  // namespace

SystemTimeClock *SystemTimeClock::GetSystemTimeClock()
{
    // Never destroyed: messages may be stamped while the process ends.
    static SystemTimeClock *const clock = new SystemTimeClock();
    return clock;
}

SystemTimeClock::SystemTimeClock()
{
    MeasureWallOffset();
    _stepNotReported.store(0, std::memory_order_relaxed);  // the first measurement is not a step
}

void SystemTimeClock::SetGpsTimeOffset()
{
    MeasureWallOffset();
}

// Reads the wall clock between two readings of the uptime. If the thread is preempted in between, the
// measurement is bad, so the tightest of a few attempts counts. A difference within the uncertainty is
// ignored, so that time does not jitter.
void SystemTimeClock::MeasureWallOffset()
{
    constexpr int attempts = 5;
    constexpr std::int64_t goodEnough = 1000;
    std::int64_t bestWidth = 0;
    std::int64_t bestOffset = 0;
    std::int64_t after = 0;
    for (int i = 0; i < attempts; ++i)
    {
        const std::int64_t before = UptimeNow();
        const std::int64_t wall = WallNow();
        after = UptimeNow();
        const std::int64_t width = after - before;
        if (i == 0 || width < bestWidth)
        {
            bestWidth = width;
            bestOffset = wall - (before + width / 2);
        }
        if (bestWidth <= goodEnough)
        {
            break;
        }
    }
    std::int64_t former = _wallOffset.load(std::memory_order_relaxed);
    // If several threads find a step at once, only one counts it.
    if (std::llabs(bestOffset - former) > bestWidth &&
        _wallOffset.compare_exchange_strong(former, bestOffset, std::memory_order_relaxed) &&
        std::llabs(bestOffset - former) >= LeastStepReported)
    {
        _stepNotReported.fetch_add(bestOffset - former, std::memory_order_relaxed);
    }
    _measuredAt.store(after, std::memory_order_release);
}

void SystemTimeClock::WriteSteps()
{
    const std::int64_t step = _stepNotReported.exchange(0, std::memory_order_relaxed);
    if (step != 0)
    {
        char text[120];
        std::snprintf(text, sizeof text, "the wall clock was set %s by %.3f s: time stamps follow",
                      step < 0 ? "back" : "forward", std::fabs(static_cast<double>(step)) * 1e-9);
        RabitLog::Write(RabitLogLevel::Warning, text);
    }
}

// Reads again if a reading is not later than the thread's last time stamp.
PostTime SystemTimeClock::ReadAfterLast()
{
    LastOfThread &last = _last;
    for (;;)
    {
        PostTime time = Read();
        const nanoseconds reading = time.GpsTime;
        if (reading <= last.Given && reading >= last.Reading - LeastStepBack)
        {
            const nanoseconds next = last.Given + nanoseconds(1);
            if (next > reading + MaxAhead)
            {
                continue;
            }
            time.GpsTime = next;
            time.GpsTimeSeconds = RabitClock::ToSeconds(next);
        }
        last = LastOfThread{time.GpsTime, reading};
        return time;
    }
}

double SystemTimeClock::GetCurrentGpsTimeInSeconds()
{
    return Now().GpsTimeSeconds;
}

double SystemTimeClock::GetCurrentUTCTimeInSeconds()
{
    return Now().GpsTimeSeconds - GetLeapSecondOffset();
}

double SystemTimeClock::GetLeapSecondOffset()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _leapSeconds;
}

void SystemTimeClock::SetLeapSecondOffset(double seconds)
{
    if (std::isnan(seconds))
    {
        return;
    }
    const std::lock_guard<std::mutex> lock(_mutex);
    _leapSeconds = std::trunc(std::clamp(seconds, 0.0, 100.0));
    UpdateAddedSeconds();
}

double SystemTimeClock::GetTimeSyncOffset()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _syncSeconds;
}

void SystemTimeClock::SetTimeSyncOffset(double seconds)
{
    if (!std::isfinite(seconds))
    {
        return;
    }
    const std::lock_guard<std::mutex> lock(_mutex);
    _syncSeconds = std::clamp(seconds, -5e9, 5e9);  // the current time still fits 63 bits of nanoseconds
    UpdateAddedSeconds();
}

void SystemTimeClock::UpdateAddedSeconds()
{
    _added.store(RabitClock::ToNanoseconds(_leapSeconds + _syncSeconds).count(), std::memory_order_relaxed);
}

double SystemTimeClock::ConvertTimePointToGpsTimeInSeconds(system_clock::time_point timePoint)
{
    const std::int64_t sinceGpsEpoch = duration_cast<nanoseconds>(timePoint.time_since_epoch()).count() -
                                       GpsEpochUnixSeconds * NanosecondsPerSecond;
    return static_cast<double>(sinceGpsEpoch) * 1e-9 + GetLeapSecondOffset();
}

double SystemTimeClock::ConvertTimePointToGpsTimeInSecondsMethod2Resolution1Second(
    system_clock::time_point timePoint)
{
    const auto seconds = std::chrono::floor<std::chrono::seconds>(timePoint.time_since_epoch()).count();
    return static_cast<double>(seconds - GpsEpochUnixSeconds) + GetLeapSecondOffset();
}

system_clock::time_point SystemTimeClock::GpsTimeSecondsToSystemClockTimepoint(double gpsTimeSeconds)
{
    const double utc = gpsTimeSeconds - GetLeapSecondOffset();
    // Whole seconds are converted separately, so that adding the difference of the epochs keeps the
    // precision.
    const double whole = std::floor(utc);
    constexpr double mostSeconds = 8e9;  // keeps the nanoseconds within 64 bits
    const std::int64_t wholeSeconds =
        std::isnan(whole) ? 0 : static_cast<std::int64_t>(std::clamp(whole, -mostSeconds, mostSeconds));
    const double fraction = std::isfinite(utc) ? utc - whole : 0.0;
    return system_clock::time_point(
        duration_cast<system_clock::duration>(std::chrono::seconds(wholeSeconds + GpsEpochUnixSeconds) +
                                              nanoseconds(static_cast<std::int64_t>(fraction * 1e9))));
}

std::tm SystemTimeClock::GetUTCTimeStructFromGpsTimeStamp(double gpsTimeSeconds)
{
    const std::time_t seconds = ToUnixSeconds(gpsTimeSeconds - GetLeapSecondOffset());
    std::tm result{};
    gmtime_r(&seconds, &result);
    return result;
}

std::tm SystemTimeClock::GetLocalTimeStructFromGpsTimeStamp(double gpsTimeSeconds)
{
    const std::time_t seconds = ToUnixSeconds(gpsTimeSeconds - GetLeapSecondOffset());
    std::tm result{};
    localtime_r(&seconds, &result);
    return result;
}

std::string SystemTimeClock::GetUTCTimeStringFromGpsTimeStamp(double gpsTimeSeconds)
{
    return AsIsoString(GetUTCTimeStructFromGpsTimeStamp(gpsTimeSeconds));
}

std::string SystemTimeClock::GetLocalTimeStringFromGpsTimeStamp(double gpsTimeSeconds)
{
    return AsIsoString(GetLocalTimeStructFromGpsTimeStamp(gpsTimeSeconds));
}

std::chrono::seconds SystemTimeClock::DurationSecondsFromUTCEpoc(int year, int mon, int day, int hour,
                                                                 int min, int sec)
{
    std::tm time{};
    time.tm_year = year - 1900;
    time.tm_mon = mon - 1;
    time.tm_mday = day;
    time.tm_hour = hour;
    time.tm_min = min;
    time.tm_sec = sec;
    return ToUTCSeconds(&time);
}

std::chrono::seconds SystemTimeClock::ToUTCSeconds(const std::tm *utc)
{
    std::tm time = *utc;  // timegm normalizes what it is given
    return std::chrono::seconds(timegm(&time));
}

std::string SystemTimeClock::clockTimepointAsString(const system_clock::time_point &timePoint)
{
    return GetUTCTimeStringFromGpsTimeStamp(
        ConvertTimePointToGpsTimeInSecondsMethod2Resolution1Second(timePoint));
}

void SystemTimeClock::printSystemClockCharacteristics()
{
    PrintCharacteristics<system_clock>("system_clock");
    PrintCharacteristics<std::chrono::steady_clock>("steady_clock");
    PrintCharacteristics<std::chrono::high_resolution_clock>("high_resolution_clock");
}

}  // namespace Rabit
