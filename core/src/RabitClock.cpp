#include <rabit/ManualClock.h>
#include <rabit/RabitClock.h>
#include <rabit/RabitManagerTrace.h>
#include <rabit/SystemTimeClock.h>
#include <rabit/UptimeClock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace Rabit
{
namespace
{

// A message costs some twenty clock readings, and traces are rare: keep this code out of the common path.
[[gnu::noinline, gnu::cold]] std::chrono::nanoseconds SeenByTrace(std::chrono::nanoseconds monotonic)
{
    const RabitManagerTrace::Pause trace;
    trace->ReadMonotonic(monotonic);
    return monotonic;
}

[[gnu::noinline, gnu::cold]] double SeenByTrace(double gpsTimeSeconds)
{
    const RabitManagerTrace::Pause trace;
    trace->ReadGpsTime(gpsTimeSeconds);
    return gpsTimeSeconds;
}

// Passes a clock reading through the trace of the current manager, if there is one.
template <typename Time>
Time Seen(Time time)
{
    return RabitManagerTrace::Current() == nullptr ? time : SeenByTrace(time);
}

class SystemRabitClock final : public RabitClock
{
public:
    std::chrono::nanoseconds Monotonic() const override
    {
        return Seen(UptimeClock::now().time_since_epoch());
    }
    double GpsTimeSeconds() const override { return Seen(_clock->Now().GpsTimeSeconds); }
    PostTime Now() const override
    {
        PostTime now = _clock->Now();
        now.GpsTimeSeconds = Seen(now.GpsTimeSeconds);
        now.Monotonic = Seen(now.Monotonic);
        return now;
    }

private:
    SystemTimeClock *const _clock = SystemTimeClock::GetSystemTimeClock();
};

double InSeconds(std::chrono::nanoseconds duration)
{
    return std::chrono::duration<double>(duration).count();
}

}  // namespace

const std::shared_ptr<RabitClock> &RabitClock::System()
{
    // Never destroyed: messages may be stamped while the process ends.
    static const auto *const clock = new std::shared_ptr<RabitClock>(std::make_shared<SystemRabitClock>());
    return *clock;
}

std::chrono::nanoseconds RabitClock::ToNanoseconds(double gpsTimeSeconds)
{
    constexpr double most = 9e9;  // the nanoseconds of it fit 63 bits
    const double bounded = std::isnan(gpsTimeSeconds) ? 0.0 : std::clamp(gpsTimeSeconds, -most, most);
    // By hand: std::floor and std::llround are calls, and each post of another clock's time comes here.
    const auto truncated = static_cast<std::int64_t>(bounded);
    const std::int64_t whole = static_cast<double>(truncated) > bounded ? truncated - 1 : truncated;
    const double rest = bounded - static_cast<double>(whole);
    return std::chrono::seconds(whole) +
           std::chrono::nanoseconds(static_cast<std::int64_t>(rest * 1e9 + 0.5));
}

ManualClock::ManualClock(double gpsTimeSeconds, std::chrono::nanoseconds monotonic)
    : _monotonic(monotonic.count()), _gpsAtZero(gpsTimeSeconds - InSeconds(monotonic))
{
}

std::chrono::nanoseconds ManualClock::Monotonic() const
{
    return Seen(std::chrono::nanoseconds(_monotonic.load()));
}

double ManualClock::GpsTimeSeconds() const
{
    return Seen(_gpsAtZero.load() + InSeconds(std::chrono::nanoseconds(_monotonic.load())));
}

void ManualClock::Advance(std::chrono::nanoseconds duration)
{
    if (duration < std::chrono::nanoseconds::zero())
    {
        throw std::invalid_argument("ManualClock::Advance: a monotonic clock does not go back");
    }
    _monotonic.fetch_add(duration.count());
}

void ManualClock::AdvanceTo(std::chrono::nanoseconds monotonic)
{
    std::int64_t now = _monotonic.load();
    while (now < monotonic.count() && !_monotonic.compare_exchange_weak(now, monotonic.count()))
    {
    }
}

void ManualClock::SetGpsTimeSeconds(double gpsTimeSeconds)
{
    _gpsAtZero.store(gpsTimeSeconds - InSeconds(std::chrono::nanoseconds(_monotonic.load())));
}

}  // namespace Rabit
