#include "presence/RecentProblems.h"

namespace Rabit
{

void RecentProblems::Note(const Gateway::Problem &problem, Duration now)
{
    const std::pair key(problem.node, problem.subject);
    if (_noted.size() >= MostRemembered && !_noted.contains(key))
    {
        std::erase_if(_noted, [now](const auto &entry) { return now - entry.second.At >= Memory; });
        if (_noted.size() >= MostRemembered)
        {
            return;
        }
    }
    _noted.insert_or_assign(key, Noted{problem, now});
}

std::vector<Gateway::Problem> RecentProblems::Problems(Duration now) const
{
    std::vector<Gateway::Problem> problems;
    for (const auto &[key, noted] : _noted)
    {
        if (now - noted.At < Memory)
        {
            problems.push_back(noted.What);
        }
    }
    return problems;
}

}  // namespace Rabit
