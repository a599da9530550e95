// Merges the targets of all aircraft into one list: pure functions.
#pragma once

#include "TargetLines.h"
#include "uav.idl.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace Ground
{

// The last targets and findings of one aircraft.
struct SaidOfTargets
{
    std::string Aircraft;
    const Uav::Targets *Targets = nullptr;  // of its sensor fusion; null if none came
    double AgeS = 0;                        // of the Targets
    const std::vector<Uav::Finding> *Findings = nullptr;
};

// A target, listed once, even if several aircraft know it.
struct ListedTarget
{
    Uav::TargetName Name;
    std::vector<Uav::TargetName> Formerly;  // the other names by which any aircraft knew or knows it
    // From the aircraft that knows the latest detection; not set if the target is only in findings.
    std::optional<Uav::Target> Target;
    double AgeS = std::numeric_limits<double>::quiet_NaN();  // since that message came
    double UnseenS = 0;                                      // before that
    std::string ToldBy;
    // The finding of the aircraft that got farthest with it; not set if no aircraft has taken it up.
    std::optional<FoundTarget> Found;
};

// Lists the targets in the order of their names. An aircraft that is gone may still know a target by a name
// that the others have merged since. So a name that any aircraft calls a former one counts as such. The
// exception: another aircraft denies it, or has a target of that name later.
std::vector<ListedTarget> ListTargets(const std::vector<SaidOfTargets> &said);

}  // namespace Ground
