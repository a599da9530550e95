#include "presence/OtherFormats.h"

namespace Rabit
{

void OtherFormats::Heard(const std::string &node, Duration now)
{
    if (_nodes.size() >= MostRemembered && _nodes.count(node) == 0)
    {
        std::erase_if(_nodes, [now](const auto &entry) { return now - entry.second >= Memory; });
        if (_nodes.size() >= MostRemembered)
        {
            return;
        }
    }
    _nodes[node] = now;
}

std::vector<Gateway::Problem> OtherFormats::Problems(Duration now) const
{
    std::vector<Gateway::Problem> problems;
    for (const auto &[node, heard] : _nodes)
    {
        if (now - heard < Memory)
        {
            Gateway::Problem &problem = problems.emplace_back();
            problem.subject = "node " + node;
            problem.node = node;
            problem.reason =
                "its gateway speaks another version of presence than this one: neither knows "
                "what the other has";
        }
    }
    return problems;
}

}  // namespace Rabit
