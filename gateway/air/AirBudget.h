#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "air/SlidingSecond.h"

namespace Rabit
{

// Decides when this node may send its next datagram. There are two limits, each of which may be absent:
//
// - a budget: a limit of the bytes in any one second.
// - a pace: a limit of the average bytes a second, for a rate that is an estimate itself (CapacityEstimate).
//
// Without a limit a datagram may be sent at once, nothing is remembered, and no time is spent. With a limit
// datagrams are spaced by their size, so that the next one never waits for a burst. A driver that comes late
// catches up to 10 ms.
//
// A datagram larger than the budget of a second is sent when nothing was sent for a second.
//
// Bytes are those on the air (AirCost). Pure; `now` never goes back; not to be used by two threads at once.
class AirBudget
{
public:
    using Duration = std::chrono::nanoseconds;
    static constexpr std::size_t SmallestDatagram = 400;  // smaller ones are mostly headers
    static constexpr Duration LongestDatagram = std::chrono::milliseconds(250);
    // With a small budget a quarter of a datagram of SmallestDatagram would be headers: a datagram up to this
    // size may take LongestThriftyDatagram.
    static constexpr std::size_t ThriftyDatagram = 576;
    static constexpr Duration LongestThriftyDatagram = std::chrono::milliseconds(400);
    static constexpr double SmallestRate = 100.0;  // bytes a second; a lower rate is raised to it

    // largestDatagram: on the air, with its headers.
    explicit AirBudget(std::size_t largestDatagram) : _largestDatagram(largestDatagram) {}

    void SetBudget(double bytesPerSecond, Duration now) { SetLimits(bytesPerSecond, {}, now); }
    void SetPace(double bytesPerSecond, Duration now) { SetLimits({}, bytesPerSecond, now); }
    // Both limits in bytes a second; empty: no such limit.
    void SetLimits(std::optional<double> budget, std::optional<double> pace, Duration now);
    bool IsUnlimited() const { return !_budget && !_pace; }
    // The lower one of the limits, in bytes a second; empty: unlimited.
    std::optional<double> Rate() const;

    // From now on keeps this much of a budget, at most half of it, free for unscheduled datagrams. No effect
    // on a pace.
    void Reserve(double bytesPerSecond) { _reserved = bytesPerSecond; }
    // `bytes` bytes were sent unscheduled, the vendor's discovery for instance. The reserved part of a budget
    // pays for them first.
    void Spent(std::size_t bytes, Duration now);

    bool MaySend(std::size_t bytes, Duration now) { return IsUnlimited() || WhenFits(bytes, now) <= now; }
    // The first time, not before now, at which a datagram of this size may be sent if nothing else is.
    Duration WhenFits(std::size_t bytes, Duration now);
    // How long the next datagram waits after one of this size. Requires a limit.
    Duration TimeOf(std::size_t bytes) const;
    // The largest datagram, at most `most` bytes, that may be sent now. Requires that a smaller one may be
    // sent now.
    std::size_t Room(std::size_t most, Duration now);
    // A datagram was sent, even one that the limits did not allow yet.
    void Sent(std::size_t bytes, Duration now);

    // The largest size of a datagram, if its maker can choose, for which more important datagrams wait no
    // longer than LongestDatagram, or LongestThriftyDatagram. At least SmallestDatagram.
    std::size_t LargestDatagram() const;

private:
    double Spacing() const;
    double Reserved() const;

    const std::size_t _largestDatagram;
    std::optional<double> _budget;
    std::optional<double> _pace;
    double _reserved = 0.0;
    Duration _nextAt = Duration::min() / 2;  // when the time of the last datagram ends
    Duration _heldUp{0};                     // since the last datagram, by unscheduled ones
    SlidingSecond _second;
};

}  // namespace Rabit
