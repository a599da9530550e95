#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// The queueing delay of each other node's newest datagram, against its quickest one, for this node's beats to
// report to that node. A large delay is reported at once, a small one now and then.
//
// A pure state machine; `now` never goes back. Bounded.
class DelayNotes
{
public:
    using Duration = std::chrono::nanoseconds;
    using Tag = std::uint32_t;

    static constexpr Duration Small = std::chrono::milliseconds(20);
    static constexpr Duration Large = std::chrono::milliseconds(60);
    // Small delays are reported with each fourth beat, but not more often than SmallPeriod, and often enough
    // that a report still counts (DelayReports::Fresh).
    static constexpr Duration SmallPeriod = std::chrono::seconds(2);
    static constexpr Duration LongestSmallPeriod = std::chrono::milliseconds(3500);
    static constexpr int SmallEachBeats = 4;
    // In a large fleet a few small delays are enough.
    static constexpr std::size_t MostSmall = 2;  // at once
    // An older delay is not reported.
    static constexpr Duration LongestHeld = std::chrono::seconds(60);
    static constexpr std::size_t MostNodes = 1000;
    static constexpr Duration Lately = std::chrono::seconds(3);  // newer notes count in Delay()
    static constexpr Duration LongestQueue = std::chrono::seconds(2);
    static constexpr Duration LongDelay = std::chrono::seconds(1);

    // Sets the time between this node's beats.
    void SetBeatPeriod(Duration period)
    {
        _smallPeriod = std::clamp(SmallEachBeats * period, SmallPeriod, LongestSmallPeriod);
    }
    // A datagram of that node came at `arrival`, by this node's monotonic clock. Returns true if the sender
    // should hear of the delay soon.
    bool Note(Tag node, Duration delay, Duration arrival);
    // Sets the queueing delay of discovery messages. Before nodes have met, only these tell it.
    void HeardLate(Duration delay) { _heardLate = delay; }
    // How long datagrams wait in queues: the median delay of the nodes that were heard lately, or that of
    // HeardLate if it is longer. At most LongestQueue, so that a clock that stood still holds nothing up for
    // long.
    Duration Delay(Duration now) const;
    // The same if a datagram came later than LongDelay lately; else 0. Costs nothing where all come in time.
    Duration LongDelayOnly(Duration now) const { return now - _longAt < Lately ? Delay(now) : Duration(0); }
    // Number of delays to report now, at most `most`.
    std::size_t Due(Duration now, std::size_t most) const;
    // Takes at most `most` delays to report now; the nodes take turns.
    std::vector<Gateway::DelayReport> Take(Duration now, std::size_t most);

private:
    struct Entry
    {
        Duration Delay{0};
        Duration Arrival{0};
        bool IsNew = false;
        Duration Told{0};  // the delay told last
        std::optional<Duration> ToldAt;
    };
    static bool IsSmall(const Entry &entry) { return entry.Delay < Small && entry.Told < Small; }
    bool IsDue(const Entry &entry, Duration now) const;

    Duration _smallPeriod = SmallPeriod;
    Duration _heardLate{0};
    Duration _longAt = -Lately;  // the last delay above LongDelay
    std::map<Tag, Entry> _notes;
    Tag _last = 0;
};

}  // namespace Rabit
