#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <optional>

namespace Rabit
{

// Decides when a State is written again on request: once for all nodes that request it. Each repetition of a
// value waits twice as long as the one before, so a node that asks without end, or lies, costs little.
//
// A pure state machine; `now` never goes back.
class RepeatPace
{
public:
    using Duration = std::chrono::nanoseconds;

    // Least time from the last write to a repetition. A sooner request was sent before that write arrived.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(50);
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    // After this time without a request, the next one counts as the first.
    static constexpr Duration Quiet = std::chrono::seconds(5);

    // A node lacks the present value.
    void Ask(Duration now)
    {
        if (_lastAsked && now - *_lastAsked >= Quiet)
        {
            _gap.Reset();
        }
        _lastAsked = now;
        _waits |= _lastWritten && now - *_lastWritten >= ShortestGap;
    }

    // The value was written, for the first time or again.
    void Written(bool isNew, Duration now)
    {
        isNew ? _gap.Reset() : static_cast<void>(_gap.Next());
        _lastWritten = now;
        _waits = false;
    }

    // When the value is to be written again; empty: no node waits for it.
    std::optional<Duration> Due() const
    {
        return _waits ? std::optional(*_lastWritten + _gap.Interval()) : std::nullopt;
    }

private:
    Backoff _gap{{ShortestGap, LongestGap}};
    std::optional<Duration> _lastAsked;
    std::optional<Duration> _lastWritten;
    bool _waits = false;
};

}  // namespace Rabit
