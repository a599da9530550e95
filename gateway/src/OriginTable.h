#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace Rabit
{

// What the transport's threads need to know of a node whose sample arrives: which life of it is the present
// one, and how its wall clock relates to our monotonic clock. Written by the gateway's thread. Thread-safe.
class OriginTable
{
public:
    struct Origin
    {
        std::uint64_t Incarnation = 0;
        // Add this to the node's wall clock (since 1970) to get this node's monotonic clock.
        std::chrono::nanoseconds WallToLocal{0};
    };

    void Set(const std::string &node, const Origin &origin)
    {
        const std::lock_guard lock(_mutex);
        _origins[node] = origin;
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
