#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace Rabit
{

// When a State is written again because others have asked for it. Once for all who ask; and whoever asks
// without end, or lies, costs little: each repetition of a value waits twice as long as the one before.
//
// A pure state machine; `now` never goes back.
class RepeatPace
{
public:
    using Duration = std::chrono::nanoseconds;

    // From the last write on. Who asks sooner asked before it came.
    static constexpr Duration ShortestGap = std::chrono::milliseconds(50);
    static constexpr Duration LongestGap = std::chrono::seconds(2);
    // Nobody has asked for so long: the next one is answered as if he were the first.
    static constexpr Duration Quiet = std::chrono::seconds(5);

    // Somebody lacks the present value.
    void Ask(Duration now)
    {
        if (_lastAsked && now - *_lastAsked >= Quiet)
        {
            _gap = ShortestGap;
        }
        _lastAsked = now;
        _waits |= _lastWritten && now - *_lastWritten >= ShortestGap;
    }

    // The value was written, for the first time or again.
    void Written(bool isNew, Duration now)
    {
        _gap = isNew ? ShortestGap : std::min(2 * _gap, LongestGap);
        _lastWritten = now;
        _waits = false;
    }

    // When it is to be written again; empty: nobody waits for it.
    std::optional<Duration> Due() const
    {
        return _waits ? std::optional(*_lastWritten + _gap) : std::nullopt;
    }

private:
    Duration _gap = ShortestGap;
    std::optional<Duration> _lastAsked;
    std::optional<Duration> _lastWritten;
    bool _waits = false;
};

}  // namespace Rabit
