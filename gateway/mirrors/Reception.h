#pragma once

#include <cstdint>
#include <string>

namespace Rabit
{

// The state of one subscription for one node.
struct Reception
{
    std::uint64_t Received = 0;  // samples posted
    int MatchedWriters = 0;      // DDS writers that match the subscription, of all nodes together
    std::string LocalProblem;    // why samples cannot be posted here; empty if they can
};

}  // namespace Rabit
