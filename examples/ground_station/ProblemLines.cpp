#include "ProblemLines.h"

#include "NodeState.h"
#include "NumberText.h"

#include <algorithm>

namespace Ground
{
namespace
{
std::string Count(std::size_t problems, double fleetAgeS)
{
    return std::to_string(problems) + (problems == 1 ? " problem" : " problems") +
           (fleetAgeS > FleetFreshS ? " (" + Format("%.0f s", fleetAgeS) + " ago)" : "");
}

std::string More(std::size_t problems)
{
    return "and " + std::to_string(problems - ProblemsOnScreen) + " more";
}

// The subject of a problem, with the name of the node where needed.
std::string Name(const Rabit::Gateway::Problem &problem, const char *before, const char *after)
{
    std::string name = Printable(problem.subject, LongestName);
    if (!problem.node.empty() && problem.subject.find(problem.node) == std::string::npos)
        name += before + Printable(problem.node, LongestName) + after;
    return name;
}
}  // namespace

std::vector<Rabit::Gateway::Problem> AllProblems(const Rabit::Gateway::Fleet &fleet)
{
    std::vector<Rabit::Gateway::Problem> problems = fleet.problems;
    for (const Rabit::Gateway::NodeStatus &status : fleet.nodes)
    {
        if (status.problems == 0)
            continue;
        Rabit::Gateway::Problem &problem = problems.emplace_back();
        problem.subject = status.node + ": " + std::to_string(status.problems) +
                          (status.problems == 1 ? " problem" : " problems");
        problem.node = status.node;
        for (const std::string &text : status.problem_texts)
            problem.reason += (problem.reason.empty() ? "" : "; ") + text;
        if (problem.reason.empty())
            problem.reason = "see its log";
    }
    return problems;
}

std::vector<TableLine> ProblemTableLines(const std::vector<Rabit::Gateway::Problem> &problems,
                                         double fleetAgeS)
{
    std::vector<TableLine> lines;
    if (problems.empty())
        return lines;
    lines.push_back({Count(problems.size(), fleetAgeS) + ":", Emphasis::Warning});
    for (std::size_t i = 0; i < std::min(problems.size(), ProblemsOnScreen); ++i)
        lines.push_back(
            {"  " + Name(problems[i], ", ", "") + ": " + Printable(problems[i].reason, LongestReason)});
    if (problems.size() > ProblemsOnScreen)
        lines.push_back({"  " + More(problems.size())});
    return lines;
}

std::string ProblemLogLine(const std::vector<Rabit::Gateway::Problem> &problems, double fleetAgeS,
                           double elapsedS)
{
    if (problems.empty())
        return "";
    std::string line = Format("%7.1f s  ", elapsedS) + Count(problems.size(), fleetAgeS) + ": ";
    for (std::size_t i = 0; i < std::min(problems.size(), ProblemsOnScreen); ++i)
        line += (i > 0 ? ", " : "") + Name(problems[i], " (", ")");
    return problems.size() > ProblemsOnScreen ? line + " " + More(problems.size()) : line;
}

}  // namespace Ground
