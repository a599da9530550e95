#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace Rabit
{

// Exponential backoff: the times at which something is repeated until it is answered. Each interval is the
// one before times a factor, up to a limit; after a number of repetitions there are no more.
//
// A pure state machine; the time is injected. Not thread-safe.
class Backoff
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::steady_clock::duration;

    struct Settings
    {
        Duration First;
        Duration Longest;
        double Factor = 2.0;
        int Most = 0;  // repetitions; 0: without end
    };

    explicit Backoff(const Settings &settings) : _settings(settings) {}

    // Begins anew, with the first repetition at `due`.
    void Begin(TimePoint due)
    {
        _due = due;
        _interval = _settings.First;
        _left = _settings.Most;
    }
    // Makes the next repetition due by `due`; the intervals after it stay unchanged.
    void Hasten(TimePoint due) { _due = _due ? std::min(*_due, due) : _due; }
    // Makes the next repetition due at `due` at the earliest; the intervals after it stay unchanged.
    void Postpone(TimePoint due) { _due = _due ? std::max(*_due, due) : _due; }
    void Stop() { _due.reset(); }
    // When the next repetition is due; empty: never.
    std::optional<TimePoint> Due() const { return _due; }
    bool IsDue(TimePoint now) const { return _due && *_due <= now; }
    // Notes that the due repetition was made. `least`: shortest interval to the next one, such as two round
    // trips; it may exceed the longest interval of the settings.
    void Done(TimePoint now, Duration least = Duration(0))
    {
        if (_settings.Most > 0 && --_left <= 0)
        {
            _due.reset();
            return;
        }
        _due = now + std::max(_interval, least);
        _interval =
            std::min(std::chrono::duration_cast<Duration>(_interval * _settings.Factor), _settings.Longest);
    }

private:
    const Settings _settings;
    std::optional<TimePoint> _due;
    Duration _interval{0};
    int _left = 0;
};

}  // namespace Rabit
