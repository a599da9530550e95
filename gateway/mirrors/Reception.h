#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace Rabit
{

// The state of one subscription for one node.
struct Reception
{
    // The incarnation of the node whose sample was posted last; empty: none was.
    std::optional<std::uint64_t> PostedOf;
    int MatchedWriters = 0;    // DDS writers that match the subscription, of all nodes together
    std::string LocalProblem;  // why samples cannot be posted here; empty if they can
};

}  // namespace Rabit
