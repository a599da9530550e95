#include "queues/LinkVersions.h"

#include <rabit/gateway/links/LinkMessages.h>

namespace Rabit
{

void LinkVersions::Heard(std::string_view node, std::uint8_t version, Duration now)
{
    if (_nodes.size() >= MostRemembered && _nodes.find(node) == _nodes.end())
    {
        std::erase_if(_nodes, [now](const auto &entry) { return now - entry.second.At >= Memory; });
        if (_nodes.size() >= MostRemembered)
        {
            return;
        }
    }
    _nodes[std::string(node)] = {version, now};
}

std::vector<Gateway::Problem> LinkVersions::Problems(Duration now) const
{
    std::vector<Gateway::Problem> problems;
    for (const auto &[node, entry] : _nodes)
    {
        if (now - entry.At < Memory)
        {
            Gateway::Problem &problem = problems.emplace_back();
            problem.subject = "node " + node;
            problem.reason = "its gateway speaks version " + std::to_string(entry.Version) +
                             " of the queue links, this one version " + std::to_string(LinkVersion) +
                             ": no queue message passes between them";
        }
    }
    return problems;
}

}  // namespace Rabit
