#pragma once

#include <algorithm>
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

// What the transport's threads need to know of a node whose sample arrives: which life of it is the present
// one, and how its clocks relate to ours. Written by the gateway's thread. Thread-safe.
class OriginTable
{
public:
    struct Origin
    {
        // What delays of the network may make the estimate wrong by.
        static constexpr std::chrono::nanoseconds Slack = std::chrono::seconds(1);

        std::uint64_t Incarnation = 0;
        PeerClock::SourceRelation Source;
        // Add this to the node's source times to get its wall clock.
        std::chrono::nanoseconds SourceToWall{0};

        // When, by this node's monotonic clock, something was posted that arrived now. Empty if that is in
        // the future by more than the slack: then the estimate rests on a beat that was held up on its way,
        // and nobody can say how old the sample is.
        std::optional<std::chrono::nanoseconds> PostedAt(std::int64_t sourceTime,
                                                         std::chrono::nanoseconds arrival) const
        {
            const std::chrono::nanoseconds posted = Source.At(std::chrono::nanoseconds(sourceTime));
            return posted > arrival + Slack ? std::nullopt : std::optional(std::min(posted, arrival));
        }
    };

    void Set(const std::string &node, const Origin &origin)
    {
        const std::lock_guard lock(_mutex);
        _origins[node] = origin;
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
        return found == _origins.end() ? std::nullopt : std::optional<Origin>(found->second);
    }

private:
    mutable std::mutex _mutex;
    std::map<std::string, Origin, std::less<>> _origins;
};

}  // namespace Rabit
