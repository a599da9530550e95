#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Nodes whose gateways speak another version of the queue links than this one, so that people learn why no
// queue message passes between them. Bounded. Not thread-safe.
class LinkVersions
{
public:
    using Duration = std::chrono::nanoseconds;

    // How long a node is named after it was last heard, and how many nodes are remembered.
    static constexpr Duration Memory = std::chrono::seconds(10);
    static constexpr std::size_t MostRemembered = 64;

    // The node speaks that version. `now` is the monotonic clock.
    void Heard(std::string_view node, std::uint8_t version, Duration now);
    std::vector<Gateway::Problem> Problems(Duration now) const;

private:
    struct Entry
    {
        std::uint8_t Version = 0;
        Duration At{0};
    };
    std::map<std::string, Entry, std::less<>> _nodes;
};

}  // namespace Rabit
