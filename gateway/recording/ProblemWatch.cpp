#include "recording/ProblemWatch.h"

#include <algorithm>
#include <utility>

namespace Rabit
{

std::string ProblemWatch::Look(const Gateway::Fleet &fleet)
{
    std::set<std::string> there;
    std::string news;
    for (const Gateway::Problem &problem : fleet.problems)
    {
        if (problem.subject == "record" || problem.subject.compare(0, 7, "record ") == 0)
        {
            continue;
        }
        const std::string text = problem.subject + ": " + problem.reason;
        std::string key = problem.node + "\n" + text;
        key.erase(std::remove_if(key.begin(), key.end(),
                                 [](char letter) { return letter >= '0' && letter <= '9'; }),
                  key.end());
        if (_there.count(key) == 0 && news.empty())
        {
            news = text;
        }
        there.insert(std::move(key));
    }
    _there = std::move(there);
    return news;
}

}  // namespace Rabit
