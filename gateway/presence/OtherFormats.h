#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Nodes whose beats are of another version than this node's, so that people learn why they are not seen.
// Bounded. Not thread-safe.
class OtherFormats
{
public:
    using Duration = std::chrono::nanoseconds;

    // A node is named for so long after its last beat; so many are.
    static constexpr Duration Memory = std::chrono::seconds(10);
    static constexpr std::size_t MostRemembered = 64;

    void Heard(const std::string &node, Duration now);
    std::vector<Gateway::Problem> Problems(Duration now) const;

private:
    std::map<std::string, Duration> _nodes;  // when each was heard last
};

}  // namespace Rabit
