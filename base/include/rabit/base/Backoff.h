#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace Rabit
{

// Exponential backoff: each interval between repetitions is the one before times a factor, up to a limit.
//
// A pure state machine, as is BackoffTimer. Not thread-safe.
class Backoff
{
public:
    using Duration = std::chrono::nanoseconds;

    struct Settings
    {
        Duration First;
        Duration Longest;
        double Factor = 2.0;
        int Most = 0;  // repetitions of a BackoffTimer; 0: without end
        // The first QuickSteps intervals are no longer than Quick: a repetition, or its answer, may be lost.
        int QuickSteps = 0;
        Duration Quick{0};
    };

    explicit Backoff(const Settings &settings) : _settings(settings), _interval(settings.First) {}

    Duration Interval() const { return _interval; }
    // Returns the interval, and lengthens it.
    Duration Next() { return Next(_settings.Factor); }
    Duration Next(double factor)
    {
        _steps += _steps < _settings.QuickSteps ? 1 : 0;
        return std::exchange(_interval,
                             std::min(std::chrono::duration_cast<Duration>(_interval * factor),
                                      _steps < _settings.QuickSteps ? _settings.Quick : _settings.Longest));
    }
    // The next interval is the first one again.
    void Reset()
    {
        _interval = _settings.First;
        _steps = 0;
    }

private:
    Settings _settings;
    Duration _interval;
    int _steps = 0;
};

// The times at which something is repeated until it is answered. The time is injected: a time point, or the
// time since some epoch.
template <typename Time>
class BackoffTimer
{
public:
    using Duration = Backoff::Duration;

    explicit BackoffTimer(const Backoff::Settings &settings) : _interval(settings), _most(settings.Most) {}

    // Begins anew, with the first repetition at `due`.
    void Begin(Time due)
    {
        _due = due;
        _interval.Reset();
        _left = _most;
    }
    // Makes the next repetition due by `due`; the intervals after it stay unchanged.
    void Hasten(Time due) { _due = _due ? std::min(*_due, due) : _due; }
    // Makes the next repetition due at `due` at the earliest; the intervals after it stay unchanged.
    void Postpone(Time due) { _due = _due ? std::max(*_due, due) : _due; }
    void Stop() { _due.reset(); }
    // The interval after the next repetition.
    Duration Interval() const { return _interval.Interval(); }
    // When the next repetition is due; empty: never.
    std::optional<Time> Due() const { return _due; }
    bool IsDue(Time now) const { return _due && *_due <= now; }
    // Notes that the due repetition was made. `least`: shortest interval to the next one, such as two round
    // trips; it may exceed the longest interval of the settings.
    void Done(Time now, Duration least = Duration(0))
    {
        const bool isLast = _most > 0 && --_left <= 0;
        _due = isLast ? std::nullopt : std::optional<Time>(now + std::max(_interval.Next(), least));
    }

private:
    Backoff _interval;
    int _most;
    int _left = 0;
    std::optional<Time> _due;
};

}  // namespace Rabit
