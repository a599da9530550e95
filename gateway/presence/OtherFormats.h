#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Nodes whose beats have another version than this node's, so that people learn why they are not seen.
// Bounded. Not thread-safe.
class OtherFormats
{
public:
    using Duration = std::chrono::nanoseconds;

    // How long a node is named after its last beat, and how many nodes are remembered.
    static constexpr Duration Memory = std::chrono::seconds(10);
    static constexpr std::size_t MostRemembered = 64;

    void Heard(const std::string &node, Duration now);
    std::vector<Gateway::Problem> Problems(Duration now) const;

private:
    std::map<std::string, Duration> _nodes;  // when each was heard last
};

}  // namespace Rabit
