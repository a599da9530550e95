#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "clocks/PeerClock.h"

namespace Rabit
{

// The present incarnation of each node, and the relation of its clocks to this node's, for the transport's
// threads when a sample arrives. Written by the gateway's thread. Thread-safe.
class OriginTable
{
public:
    struct Origin
    {
        // Largest error of the estimate that network delays may cause.
        static constexpr std::chrono::nanoseconds Slack = std::chrono::seconds(1);

        std::uint64_t Incarnation = 0;
        PeerClock::SourceRelation Source;
        // Add this to the node's source times to get its wall clock.
        std::chrono::nanoseconds SourceToWall{0};

        // When, by this node's monotonic clock, the sample that arrived at `arrival` was posted. Empty if
        // that is later than `arrival` by more than the slack: the estimate then rests on a beat that was
        // held up on its way, and the age of the sample is unknown.
        std::optional<std::chrono::nanoseconds> PostedAt(std::int64_t sourceTime,
                                                         std::chrono::nanoseconds arrival) const
        {
            const std::chrono::nanoseconds posted = Source.At(std::chrono::nanoseconds(sourceTime));
            return posted > arrival + Slack ? std::nullopt : std::optional(std::min(posted, arrival));
        }
    };

    // An incarnation that another one has replaced never comes back: over several paths, the beats of the new
    // one come by one of them first, and the others still know the former one. It is ignored.
    void Set(const std::string &node, const Origin &origin)
    {
        const std::lock_guard lock(_mutex);
        Known &known = _origins[node];
        const std::uint64_t present = known.Present.Incarnation;
        if (origin.Incarnation != 0 &&
            std::find(known.Former.begin(), known.Former.end(), origin.Incarnation) != known.Former.end())
        {
            return;
        }
        if (present != 0 && present != origin.Incarnation)
        {
            std::rotate(known.Former.rbegin(), known.Former.rbegin() + 1, known.Former.rend());
            known.Former.front() = present;
        }
        known.Present = origin;
    }

    void Forget(const std::string &node)
    {
        const std::lock_guard lock(_mutex);
        _origins.erase(node);
    }

    // Empty: the node has not been heard.
    std::optional<Origin> Find(std::string_view node) const
    {
        const std::lock_guard lock(_mutex);
        const auto found = _origins.find(node);
        return found == _origins.end() ? std::nullopt : std::optional<Origin>(found->second.Present);
    }

private:
    struct Known
    {
        Origin Present{};
        std::array<std::uint64_t, 4> Former{};  // incarnations, the last one first; 0: none
    };

    mutable std::mutex _mutex;
    std::map<std::string, Known, std::less<>> _origins;
};

}  // namespace Rabit
