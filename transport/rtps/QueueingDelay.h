#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace Rabit::Rtps
{

// Queueing delay of one sender's datagrams: their time on the way beyond the shortest of any. It shows the
// queues in front of a full radio. Each datagram carries its sending time by its sender's clock; only
// differences count, so the clocks need not agree (LEDBAT, RFC 6817).
//
// A node that comes to a full channel hears no datagram without a delay. The round trip of a request and its
// answer tells it: half of that counts as the delay of the answer, path included, which gives the shortest
// time.
//
// The shortest time is that of the last one to two minutes, so clocks that drift apart by 100 ppm add at most
// 12 ms. A delay above Longest counts as none: a clock has stood still, with its computer.
//
// Pure; the time is injected. Not thread-safe.
class QueueingDelay
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::milliseconds;

    static constexpr Duration Longest{10000};
    static constexpr std::chrono::seconds Window{60};
    // Validity of a measurement. After a measured round trip it is valid for that time longer, until the
    // answer to the next request can have come.
    static constexpr std::chrono::seconds Fresh{3};

    // The own clock's time for a datagram to carry. Wraps around every 49 days.
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
        _last = offset;
        _heardAt = now;
    }

    // The last datagram heard answers one that this node sent at `sentAt` of its clock.
    void Answered(std::uint32_t sentAt, TimePoint now)
    {
        const Duration took(static_cast<std::int32_t>(Stamp(now) - sentAt));
        if (!_heardAt || took < Duration(0) || took > 2 * Longest)
        {
            return;
        }
        // Half of the round trip is the delay, path included, where it is longer than what was measured. A
        // delay longer than the round trip is wrong: the peer's clock stood still, with its computer.
        if (took / 2 > _delay || took < _delay)
        {
            _delay = took / 2;
            _least = _before = static_cast<std::int32_t>(static_cast<std::uint32_t>(_last) -
                                                         static_cast<std::uint32_t>(_delay.count()));
        }
        _answeredAt = now;
        _roundTrip = took;
    }

    // Delay of the last datagram heard.
    Duration OfLast() const { return _delay; }
    // Current delay; empty: nothing was heard lately.
    std::optional<Duration> At(TimePoint now) const
    {
        const Duration longer = IsByAnswer(now) ? _roundTrip : Duration(0);
        return _heardAt && now - *_heardAt < Fresh + longer ? std::optional(_delay) : std::nullopt;
    }
    // True if a recent round trip has determined the shortest time.
    bool IsByAnswer(TimePoint now) const { return _answeredAt && now - *_answeredAt < Window; }

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
    std::int32_t _last = 0;
    Duration _delay{0};
    std::optional<TimePoint> _answeredAt;
    Duration _roundTrip{0};
};

}  // namespace Rabit::Rtps
