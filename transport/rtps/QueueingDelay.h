#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace Rabit::Rtps
{

// How long the datagrams of one sender wait on their way, beyond the least that any of them took: the time in
// queues in front of a radio that is full. Each datagram says when it was sent, by its sender's clock; only
// differences count, so the clocks need not agree (LEDBAT, RFC 6817).
//
// One that comes to a channel which is full already has heard no datagram that did not wait. A round trip
// tells it: that is at least as long as the wait.
//
// The least is that of the last one to two minutes, so clocks that drift apart by 100 ppm add 12 ms at most.
// A delay above Longest is none: a clock has stood still, with its computer.
//
// Pure; the time is injected. Not thread-safe.
class QueueingDelay
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::milliseconds;

    static constexpr Duration Longest{10000};
    static constexpr std::chrono::seconds Window{60};
    // A measurement counts for so long.
    static constexpr std::chrono::seconds Fresh{3};

    // The time of the own clock that a datagram carries. Wraps around every 49 days.
    static std::uint32_t Stamp(TimePoint now)
    {
        return static_cast<std::uint32_t>(
            std::chrono::duration_cast<Duration>(now.time_since_epoch()).count());
    }

    void Heard(std::uint32_t sentAt, TimePoint now)
    {
        const auto offset = static_cast<std::int32_t>(Stamp(now) - sentAt);
        if (!_heardAt || now - *_heardAt >= 2 * Window || Above(_before, offset) > Longest)
        {
            _least = _before = offset;
            _windowEnd = now + Window;
        }
        else if (now >= _windowEnd)
        {
            _before = std::exchange(_least, offset);
            _windowEnd = now + Window;
        }
        if (Above(offset, _least) > Duration(0))
        {
            _least = offset;
        }
        if (Above(offset, _before) > Duration(0))
        {
            _before = offset;
        }
        _delay = Above(_before, offset);
        _heardAt = now;
    }

    // An answer to what this node sent at that time of its clock.
    void Answered(std::uint32_t sentAt, TimePoint now)
    {
        const Duration took(static_cast<std::int32_t>(Stamp(now) - sentAt));
        if (took >= Duration(0) && took <= Longest)
        {
            _roundTrip = took;
            _answeredAt = now;
        }
    }

    // Of the datagram that was heard last.
    Duration OfLast() const { return _delay; }
    // Of now; empty: nothing was heard lately.
    std::optional<Duration> At(TimePoint now) const
    {
        const auto isFresh = [now](const std::optional<TimePoint> &time)
        { return time && now - *time < Fresh; };
        if (!isFresh(_heardAt))
        {
            return std::nullopt;
        }
        return isFresh(_answeredAt) ? std::max(_delay, _roundTrip) : _delay;
    }

private:
    // Offsets wrap around with the stamps: only their differences say something.
    static Duration Above(std::int32_t least, std::int32_t offset)
    {
        return Duration(static_cast<std::int32_t>(static_cast<std::uint32_t>(offset) -
                                                  static_cast<std::uint32_t>(least)));
    }

    std::int32_t _least = 0;   // of this window
    std::int32_t _before = 0;  // of this window and the one before
    TimePoint _windowEnd{};
    std::optional<TimePoint> _heardAt;
    Duration _delay{0};
    std::optional<TimePoint> _answeredAt;
    Duration _roundTrip{0};
};

}  // namespace Rabit::Rtps
