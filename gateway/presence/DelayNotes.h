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

// How late the newest datagram of each other node came against its quickest, for this node's beats to tell
// them. News of a delay is told at once, that there is none now and then.
//
// A pure state machine; `now` never goes back. Bounded.
class DelayNotes
{
public:
    using Duration = std::chrono::nanoseconds;
    using Tag = std::uint32_t;

    static constexpr Duration Small = std::chrono::milliseconds(20);
    static constexpr Duration Large = std::chrono::milliseconds(60);
    // With each fourth beat, but not more often than this, and while it still counts (DelayReports::Fresh).
    static constexpr Duration SmallPeriod = std::chrono::seconds(2);
    static constexpr Duration LongestSmallPeriod = std::chrono::milliseconds(3500);
    static constexpr int SmallEachBeats = 4;
    // In a large fleet a few of them are enough.
    static constexpr std::size_t MostSmall = 2;  // at once
    // Older news is none.
    static constexpr Duration LongestHeld = std::chrono::seconds(60);
    static constexpr std::size_t MostNodes = 1000;
    static constexpr Duration Lately = std::chrono::seconds(3);  // such notes count for the delay
    static constexpr Duration LongestQueue = std::chrono::seconds(2);

    // How often this node beats.
    void SetBeatPeriod(Duration period)
    {
        _smallPeriod = std::clamp(SmallEachBeats * period, SmallPeriod, LongestSmallPeriod);
    }
    // A datagram of that node came at `arrival`, by this node's monotonic clock. Returns whether its sender
    // should hear of it soon.
    bool Note(Tag node, Duration delay, Duration arrival);
    // By how much datagrams are late now: half of the nodes that were heard lately are later than that, half
    // less. At most LongestQueue, so that a clock that stood still holds nothing up for long. 0: none was
    // heard.
    Duration Delay(Duration now) const;
    // How many there are to be told, no more than `most`.
    std::size_t Due(Duration now, std::size_t most) const;
    // What is to be told now, in turns.
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
    std::map<Tag, Entry> _notes;
    Tag _last = 0;
};

}  // namespace Rabit
