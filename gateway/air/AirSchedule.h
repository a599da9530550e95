#pragma once

#include <rabit/gateway/TrafficClass.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "air/AirBudget.h"
#include "air/AirStream.h"
#include "air/ClassShares.h"
#include "air/FairQueue.h"
#include "air/StreamId.h"

namespace Rabit
{

// What a node puts on the air next, and when. Whoever sends is a stream, says when it has something and how
// many bytes on the air its next datagram takes, and makes that datagram when its turn has come, so that what
// goes is the newest:
//
//     const StreamId pose = schedule.AddStream(TrafficClass::Telemetry, 3.0);
//     schedule.Ready(pose, 190);
//     ...
//     while (const auto next = schedule.Next(now))
//     {
//         schedule.Sent(*next, SendOneDatagramOf(*next), now);
//         if (there is more of it) schedule.Ready(*next, bytesOfItsNext);
//     }
//     sleep until schedule.NextDue(now), or until something becomes ready
//
// Between classes ClassShares decides, between the streams of a class FairQueue, and the time is AirBudget's.
// Nobody's share is kept for who has nothing to send. What is chosen and does not fit into the budget yet
// keeps its turn; for the first 250 ms commands may pass it if they fit, for a second what is promised, then
// nothing.
//
// One stream may promise its next datagram by a deadline (Promise). A datagram that would end after the
// deadline lets the promised one go first, whatever the classes' shares are.
//
// All calls take O(log n) for n streams, and none allocates but AddStream; without a limit a call is some
// comparisons. Pure; `now` never goes back; not to be used by two threads at once. A stream that is not there
// is a programming error: std::out_of_range.
class AirSchedule
{
public:
    using Duration = std::chrono::nanoseconds;
    static constexpr Duration Never = Duration::max();
    static constexpr Duration Patience = std::chrono::milliseconds(250);
    static constexpr Duration LongestPatience = std::chrono::seconds(1);
    // A driver need not wake more often than this; what it misses meanwhile it catches up.
    static constexpr Duration Grain = std::chrono::milliseconds(1);
    static constexpr double SmallestWeight = 0.01;
    static constexpr double LargestWeight = 100.0;

    // largestDatagram: on the air, with its headers. Unlimited at the beginning.
    explicit AirSchedule(std::size_t largestDatagram);

    // AirBudget::SetLimits
    void SetLimits(std::optional<double> budget, std::optional<double> pace, Duration now);
    void SetUnlimited() { SetLimits({}, {}, Duration(0)); }
    void SetBudget(double bytesPerSecond, Duration now) { SetLimits(bytesPerSecond, {}, now); }
    void SetPace(double bytesPerSecond, Duration now) { SetLimits({}, bytesPerSecond, now); }
    void Reserve(double bytesPerSecond);
    void Spent(std::size_t bytes, Duration now) { _budget.Spent(bytes, now); }
    const AirBudget &Budget() const { return _budget; }
    // AirBudget::Room
    std::size_t Room(std::size_t most, Duration now) { return _budget.Room(most, now); }

    // The weight holds among streams of its class, SmallestWeight to LargestWeight.
    StreamId AddStream(TrafficClass traffic, double weight = 1.0);
    void Remove(StreamId id);
    // The stream has a datagram of so many bytes, more than 0; or of so many now, if it was ready before.
    void Ready(StreamId id, std::size_t bytes);
    // It has nothing any more.
    void NotReady(StreamId id);

    // With a limit: the stream sends a datagram of so many bytes, more than 0, by `deadline`, whether it is
    // ready before or not. It goes early, by 420 ms at most, where
    // another datagram would make it late. Only a datagram that has been kept for LongestPatience goes before
    // it. Holds until the stream has sent. One stream at a time: a later promise replaces an earlier one.
    void Promise(StreamId id, std::size_t bytes, Duration deadline);

    // Who is to send one datagram of now; empty: nobody, before NextDue. The same one until something
    // changes.
    std::optional<StreamId> Next(Duration now);
    // It did, so many bytes on the air, and is not ready until it says so. 0: it had nothing after all. May
    // be said of any stream: what goes past the schedule is paid for, too.
    void Sent(StreamId id, std::size_t bytes, Duration now);
    // When to ask Next again if nothing else happens; now, if somebody may send; Never, if nobody has
    // anything.
    Duration NextDue(Duration now);

    // Bytes sent since the beginning.
    std::uint64_t SentBytes(TrafficClass traffic) const
    {
        return _sent.at(static_cast<std::size_t>(traffic));
    }
    std::uint64_t SentBytes(StreamId id) const;

private:
    void LimitChanged();
    const AirStream &At(StreamId id) const;
    AirStream &At(StreamId id);
    FairQueue &QueueOf(TrafficClass traffic) { return _queues[static_cast<std::size_t>(traffic)]; }
    ClassShares::Waiting Waiting() const;
    void StopWaiting(AirStream &stream);
    bool IsAnyoneReady() const;
    AirStream *KeptForLong(Duration now) const;
    Duration MustGoBy(const AirStream &other, Duration now) const;
    AirStream &Chosen(Duration now);
    AirStream *Passing(const AirStream &chosen, Duration now, Duration &when);

    AirBudget _budget;
    ClassShares _shares;
    std::array<FairQueue, TrafficClassCount> _queues;
    std::deque<AirStream> _streams;  // addresses stay
    std::vector<std::uint32_t> _free;
    std::array<std::uint64_t, TrafficClassCount> _sent{};
    AirStream *_kept = nullptr;  // chosen, and does not fit yet
    Duration _keptSince{0};
    AirStream *_promised = nullptr;
    Duration _deadline{0};  // of that one
};

}  // namespace Rabit
