#include "ReplayLine.h"

#include "FleetTable.h"

namespace Ground
{

std::vector<std::string> ReplayedNodes(const Rabit::Gateway::Fleet &fleet)
{
    std::vector<std::string> nodes;
    for (const Rabit::Gateway::NodeStatus &status : fleet.nodes)
        if (status.replay && status.state != Rabit::Gateway::NodeState::LOST)
            nodes.push_back(status.node);
    return nodes;
}

std::string ReplayLine(const Rabit::Gateway::Fleet &fleet)
{
    constexpr std::size_t mostNamed = 6;
    constexpr std::size_t longestName = 24;
    const std::vector<std::string> nodes = ReplayedNodes(fleet);
    std::string names;
    for (std::size_t i = 0; i < nodes.size() && i < mostNamed; ++i)
        names += (i == 0 ? "" : ", ") + Printable(nodes[i], longestName);
    if (nodes.size() > mostNamed)
        names += " and " + std::to_string(nodes.size() - mostNamed) + " more";
    return nodes.empty() ? "" : "REPLAY of a recording, not live: " + names;
}

}  // namespace Ground
