#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "air/SlidingSecond.h"

namespace Rabit
{

// When this node may put its next datagram on the air. Two limits, each of which may be absent:
//
// - a budget: never more than so many bytes in a second, whichever second one looks at.
// - a pace: so many bytes a second on average, for a rate that is an estimate itself (CapacityEstimate).
//
// Without a limit a datagram may go at once. Nothing is remembered then, and nothing costs time. With a limit
// datagrams are spaced by their size, so that the next one, whosever it is, never waits for a
// burst. A driver that comes late catches up to 10 ms.
//
// Something always goes: a datagram that is larger than what a budget allows goes when nothing was sent for a
// second.
//
// Bytes are those on the air (AirCost). Pure; `now` never goes back; not to be used by two threads at once.
class AirBudget
{
public:
    using Duration = std::chrono::nanoseconds;
    static constexpr std::size_t SmallestDatagram = 400;  // smaller ones are mostly headers
    static constexpr Duration LongestDatagram = std::chrono::milliseconds(250);
    // With a small budget a quarter of a datagram of SmallestDatagram would be headers: up to this many bytes
    // it may take longer.
    static constexpr std::size_t ThriftyDatagram = 576;
    static constexpr Duration LongestThriftyDatagram = std::chrono::milliseconds(400);
    static constexpr double SmallestRate = 100.0;  // bytes a second; less is raised to it

    // largestDatagram: on the air, with its headers.
    explicit AirBudget(std::size_t largestDatagram) : _largestDatagram(largestDatagram) {}

    // At the beginning.
    void SetUnlimited() { SetLimits({}, {}, Duration(0)); }
    void SetBudget(double bytesPerSecond, Duration now) { SetLimits(bytesPerSecond, {}, now); }
    void SetPace(double bytesPerSecond, Duration now) { SetLimits({}, bytesPerSecond, now); }
    // In bytes a second; empty: there is no such limit.
    void SetLimits(std::optional<double> budget, std::optional<double> pace, Duration now);
    bool IsUnlimited() const { return !_budget && !_pace; }
    // The lower one of the limits, in bytes a second; empty: unlimited.
    std::optional<double> Rate() const;

    // Keeps so much of a budget, at most half of it, free from now on for what is not scheduled. Without
    // effect on a pace.
    void Reserve(double bytesPerSecond) { _reserved = bytesPerSecond; }
    // So many bytes went without being scheduled, the vendor's discovery for instance. What a budget has
    // reserved pays for them first.
    void Spent(std::size_t bytes, Duration now);

    bool MaySend(std::size_t bytes, Duration now) { return IsUnlimited() || WhenFits(bytes, now) <= now; }
    // The first time, not before now, at which a datagram of this size may go if nothing else does.
    Duration WhenFits(std::size_t bytes, Duration now);
    // How long the next datagram waits after one of this size. Not without a limit.
    Duration TimeOf(std::size_t bytes) const;
    // How large a datagram may be that goes now, `most` at most. For who knows that a smaller one may.
    std::size_t Room(std::size_t most, Duration now);
    // A datagram went. Also one that MaySend would not have let go.
    void Sent(std::size_t bytes, Duration now);

    // How large a datagram should be, where one has the choice, so that what is more important does not wait
    // longer than LongestDatagram for it, or LongestThriftyDatagram; SmallestDatagram at least.
    std::size_t LargestDatagram() const;

private:
    double Spacing() const;
    double Reserved() const;

    const std::size_t _largestDatagram;
    std::optional<double> _budget;
    std::optional<double> _pace;
    double _reserved = 0.0;
    Duration _nextAt = Duration::min() / 2;  // the last datagram has had its time
    Duration _heldUp{0};                     // since it went, by what was not scheduled
    SlidingSecond _second;
};

}  // namespace Rabit
