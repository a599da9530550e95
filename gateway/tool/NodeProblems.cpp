#include "NodeProblems.h"

#include <algorithm>
#include <string>

namespace Rabit::Tool
{

std::vector<Gateway::Problem> ProblemsOfNodes(const Gateway::Fleet &fleet)
{
    std::vector<Gateway::Problem> problems;
    const auto add = [&problems](const std::string &node, const std::string &reason) {
        problems.push_back({"node " + node, node, reason});
    };
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        for (const std::string &text : status.problem_texts)
        {
            add(status.node, text);
        }
        const std::size_t told = status.problem_texts.size();
        if (status.problems > told)
        {
            const std::size_t more = status.problems - told;
            add(status.node, "it has " + std::to_string(more) + (told > 0 ? " more" : "") +
                                 (more == 1 ? " problem" : " problems") + "; see `rabit log " + status.node +
                                 "`");
        }
    }
    return problems;
}

bool AreProblemsKnown(const std::vector<FleetExplorer::Node> &nodes)
{
    return std::all_of(nodes.begin(), nodes.end(),
                       [](const FleetExplorer::Node &node)
                       { return node.AreProblemsKnown || node.State == Gateway::NodeState::LOST; });
}

}  // namespace Rabit::Tool
