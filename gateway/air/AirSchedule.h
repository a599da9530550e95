#pragma once

#include <rabit/gateway/AirCost.h>
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

// Decides which datagram a node sends next, and when. Each sender is a stream. It reports when it has
// something to send, and the size of its next datagram on the air. It makes the datagram when its turn has
// come, so that the newest contents are sent:
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
// ClassShares chooses the class, FairQueue the stream in it, and AirBudget the time. An idle stream's share
// goes to the others. A chosen stream whose datagram does not fit the budget yet keeps its turn. For the
// first 250 ms commands that fit may pass it, for a second promised datagrams, then nothing.
//
// Behind the datagram of the chosen stream, other streams may ride: their datagrams join it, without headers
// of their own (NextRider).
//
// One stream may promise its next datagram by a deadline (Promise). A datagram that would end after the
// deadline lets the promised one go first, whatever the classes' shares are.
//
// All calls take O(log n) for n streams, and only AddStream allocates; without a limit a call is some
// comparisons. Pure; `now` never goes back; not to be used by two threads at once. An unknown stream is a
// programming error: std::out_of_range.
class AirSchedule
{
public:
    using Duration = std::chrono::nanoseconds;
    static constexpr Duration Never = Duration::max();
    static constexpr Duration Patience = std::chrono::milliseconds(250);
    static constexpr Duration LongestPatience = std::chrono::seconds(1);
    // Shortest useful time between a driver's wake-ups. Datagrams that fall due in between are sent at the
    // next one.
    static constexpr Duration Grain = std::chrono::milliseconds(1);
    static constexpr double SmallestWeight = 0.01;
    static constexpr double LargestWeight = 100.0;

    // largestDatagram: bytes on the air, with headers. Unlimited at the beginning.
    explicit AirSchedule(std::size_t largestDatagram);

    // AirBudget::SetLimits
    void SetLimits(std::optional<double> budget, std::optional<double> pace, Duration now);
    void SetBudget(double bytesPerSecond, Duration now) { SetLimits(bytesPerSecond, {}, now); }
    void SetPace(double bytesPerSecond, Duration now) { SetLimits({}, bytesPerSecond, now); }
    void Reserve(double bytesPerSecond);
    void Spent(std::size_t bytes, Duration now) { _budget.Spent(bytes, now); }
    const AirBudget &Budget() const { return _budget; }
    // True if a datagram of that size may go past the schedule now; SentPast pays for it as for any other.
    bool MaySend(std::size_t bytes, Duration now) { return _budget.MaySend(bytes, now); }
    void SentPast(std::size_t bytes, Duration now) { _budget.Sent(bytes, now); }
    // AirBudget::Room
    std::size_t Room(std::size_t most, Duration now) { return _budget.Room(most, now); }

    // The weight holds among streams of its class, SmallestWeight to LargestWeight.
    StreamId AddStream(TrafficClass traffic, double weight = 1.0);
    void Remove(StreamId id);
    // The stream has a datagram of `bytes` bytes, more than 0. A stream that was ready before changes its
    // size.
    void Ready(StreamId id, std::size_t bytes);
    // The stream has nothing to send any more.
    void NotReady(StreamId id);

    // With a limit: the stream will send a datagram of `bytes` bytes, more than 0, by `deadline`, whether it
    // is ready before or not. It is sent early, by 420 ms at most, if another datagram would make it late.
    // Only a datagram that has been kept for LongestPatience goes before it. Holds until the stream has sent.
    // One stream at a time: a later promise replaces an earlier one.
    void Promise(StreamId id, std::size_t bytes, Duration deadline);

    // Bytes of the headers that a datagram lacks once it has joined another one.
    static constexpr std::size_t JoinedHeaders = AirCost::IpAndUdp + AirCost::RtpsHeader;

    TrafficClass ClassOf(StreamId id) const { return At(id).Class; }
    // With a limit: the stream may send a datagram of `bytes` bytes, more than 0, behind another one before
    // it is due. Holds until it sends, or NotReady. One stream at a time.
    void MayRide(StreamId id, std::size_t bytes);
    // Where a datagram went.
    struct Destinations
    {
        std::uint64_t Number = 0;  // equal for equal sets of destinations; 0: not known
        std::size_t Count = 0;     // of the set
    };
    // The last datagram of the stream went there.
    void Went(StreamId id, const Destinations &to) { At(id).Destinations = to.Number; }
    // The stream whose datagram is to join one of class `first` that goes there and has room for `room` bytes
    // more for each destination: the stream that MayRide, or else the next one of the most important class
    // that may go on. A class may if it has credit, if it is `first`, and behind a beat: so it overdraws its
    // credit by a datagram at most. Empty: that stream's last datagram went elsewhere. Also empty: its next
    // one does not fit the datagram or the budget, would make a promised one late, or would take more than
    // the stream's share. No stream rides without a limit, and while a large datagram waits.
    std::optional<StreamId> NextRider(TrafficClass first, const Destinations &to, std::size_t room,
                                      Duration now);

    // The stream that is to send one datagram now; empty: none before NextDue. Returns the same stream until
    // something changes.
    std::optional<StreamId> Next(Duration now);
    // The stream sent `bytes` bytes on the air, and is not ready until Ready. 0: it had nothing after all.
    // May be called for any stream, to pay for bytes sent past the schedule.
    void Sent(StreamId id, std::size_t bytes, Duration now);
    // When to call Next again if nothing else happens; now, if a stream may send; Never, if no stream has
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
    bool Rides(const AirStream &stream, const Destinations &to, std::size_t room, Duration now);
    AirStream *Passing(const AirStream &chosen, Duration now, Duration &when);

    AirBudget _budget;
    ClassShares _shares;
    std::array<FairQueue, TrafficClassCount> _queues;
    std::deque<AirStream> _streams;  // addresses stay
    std::vector<std::uint32_t> _free;
    std::array<std::uint64_t, TrafficClassCount> _sent{};
    AirStream *_kept = nullptr;  // the chosen stream whose datagram does not fit yet
    Duration _keptSince{0};
    AirStream *_early = nullptr;  // may ride
    AirStream *_promised = nullptr;
    Duration _deadline{0};  // of the promised datagram
};

}  // namespace Rabit
