#include "queues/UnwantedSenders.h"

namespace Rabit
{

void UnwantedSenders::Refused(std::string_view node, std::string_view queue, Duration now)
{
    const std::pair<std::string, std::string> link(node, queue);
    if (_last.size() >= MostRemembered && _last.count(link) == 0)
    {
        std::erase_if(_last, [now](const auto &entry) { return now - entry.second >= Memory; });
        if (_last.size() >= MostRemembered)
        {
            return;
        }
    }
    _last[link] = now;
}

std::vector<Gateway::Problem> UnwantedSenders::Problems(Duration now) const
{
    std::vector<Gateway::Problem> problems;
    for (const auto &[link, last] : _last)
    {
        if (now - last < Memory)
        {
            Gateway::Problem &problem = problems.emplace_back();
            problem.subject = "accept " + link.second;
            problem.node = link.first;
            problem.reason = link.first + " sends messages to queue `" + link.second +
                             "`, which accepts none of it: they are refused";
        }
    }
    return problems;
}

}  // namespace Rabit
