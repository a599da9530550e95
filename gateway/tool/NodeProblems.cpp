#include "NodeProblems.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>

#include "Table.h"

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
                                 (more == 1 ? " problem" : " problems") + "; see its log, by `rabit log`");
        }
    }
    return problems;
}

std::vector<Gateway::Problem> Joined(const std::vector<Gateway::Problem> &problems)
{
    std::vector<Gateway::Problem> joined;
    std::vector<std::vector<std::string>> nodes;  // of each of them
    std::map<std::string, std::size_t> places;    // by the reason
    for (const Gateway::Problem &problem : problems)
    {
        const bool isOfNode = !problem.node.empty() && problem.subject == "node " + problem.node;
        const auto known = isOfNode ? places.find(problem.reason) : places.end();
        if (known == places.end())
        {
            if (isOfNode)
            {
                places.emplace(problem.reason, joined.size());
            }
            joined.push_back(problem);
            nodes.push_back({problem.node});
        }
        else if (std::vector<std::string> &same = nodes[known->second];
                 std::find(same.begin(), same.end(), problem.node) == same.end())
        {
            same.push_back(problem.node);
        }
    }
    for (std::size_t at = 0; at < joined.size(); ++at)
    {
        if (nodes[at].size() > 1)
        {
            joined[at].subject = "nodes " + NamesText(nodes[at]);
            joined[at].node.clear();
        }
    }
    return joined;
}

bool AreProblemsKnown(const std::vector<FleetExplorer::Node> &nodes)
{
    return std::all_of(nodes.begin(), nodes.end(),
                       [](const FleetExplorer::Node &node)
                       { return node.AreProblemsKnown || node.State == Gateway::NodeState::LOST; });
}

}  // namespace Rabit::Tool
