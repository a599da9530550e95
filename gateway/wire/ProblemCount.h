#pragma once

#include <cstdint>

namespace Rabit
{

// The problems of a node, as its beats tell them. The texts are a report (NodeReports::Kind::Problems).
struct ProblemCount
{
    std::uint16_t Count = 0;   // 65535 stands for more, too
    std::uint32_t Digest = 0;  // changes with the problems

    bool operator==(const ProblemCount &) const = default;
};

}  // namespace Rabit
