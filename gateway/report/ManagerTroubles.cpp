#include "report/ManagerTroubles.h"

#include <string>

#include "report/RoughTime.h"

namespace Rabit::ManagerTroubles
{
namespace
{

// A unit of work that throws may succeed at the next turn, and one that is late may be so for once, as after
// this process stood still. The rest does not end by itself soon.
Gateway::Problem ProblemOf(const ManagerTrouble &trouble)
{
    Gateway::Problem problem;
    problem.subject = "manager " + trouble.Manager;
    const bool isWork = trouble.Step == "ExecuteUnitOfWork";
    problem.certain = !isWork;
    const std::string step = isWork ? "its unit of work" : "its " + trouble.Step;
    if (trouble.HangsFor > std::chrono::nanoseconds::zero())
    {
        problem.reason = step + " has not returned for more than " + RoughTime(trouble.HangsFor) +
                         "; its wake-ups, its queue and a shutdown wait for it";
        return problem;
    }
    problem.reason = step + " threw: " + trouble.Failure;
    if (trouble.Step == "Startup")
    {
        problem.reason += "; it does not run";
    }
    return problem;
}

}  // namespace

std::vector<Gateway::Problem> ProblemsOf(const std::vector<ManagerTrouble> &troubles)
{
    std::vector<Gateway::Problem> problems;
    problems.reserve(troubles.size());
    for (const ManagerTrouble &trouble : troubles)
    {
        problems.push_back(ProblemOf(trouble));
    }
    return problems;
}

}  // namespace Rabit::ManagerTroubles
