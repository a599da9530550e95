#pragma once

#include <cstdint>

namespace Rabit
{

// The problems of a node, as its beats tell them. The texts are a report (NodeReports::Kind::Problems).
struct ProblemCount
{
    std::uint16_t Count = 0;   // 65535: or more
    std::uint32_t Digest = 0;  // another one: other problems

    bool operator==(const ProblemCount &) const = default;
};

}  // namespace Rabit
