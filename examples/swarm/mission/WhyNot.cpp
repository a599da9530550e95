#include "WhyNot.h"

#include "Limits.h"

namespace Swarm
{
namespace
{
constexpr Common::Range SigmaM{0, 1000};

// A visitor for ForEachNumberOf...: keeps the problem of the first wrong number.
auto KeepFirstProblem(std::string &problem)
{
    return [&problem](const char *name, auto value, const Common::Range &range)
    {
        if (problem.empty())
            problem = Common::WhyNot(name, value, range);
    };
}
}  // namespace

std::string WhyNot(const Uav::Goto &command)
{
    std::string problem;
    Common::ForEachNumberOfGoto(command, KeepFirstProblem(problem));
    return problem;
}

std::string WhyNot(const Uav::SearchArea &area)
{
    std::string problem;
    Common::ForEachNumberOfArea(area, KeepFirstProblem(problem));
    return problem;
}

std::string WhyNot(const Uav::TargetReport &report)
{
    if (report.seen_by.empty())
        return "seen_by is empty";
    std::string problem;
    const auto check = KeepFirstProblem(problem);
    check("sigma_m", report.sigma_m, SigmaM);
    check("latitude_deg", report.latitude_deg, Common::LatitudeDeg);
    check("longitude_deg", report.longitude_deg, Common::LongitudeDeg);
    return problem;
}

}  // namespace Swarm
