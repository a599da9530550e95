// What all aircraft say of targets as one list: pure functions.
#pragma once

#include "TargetLines.h"
#include "uav.idl.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace Ground
{

// What one aircraft said last.
struct SaidOfTargets
{
    std::string Aircraft;
    const Uav::Targets *Targets = nullptr;  // of its sensor fusion; null if it has said nothing
    double AgeS = 0;                        // of that
    const std::vector<Uav::Finding> *Findings = nullptr;
};

// A target, once, however many aircraft know it.
struct ListedTarget
{
    Uav::TargetName Name;
    std::vector<Uav::TargetName> Formerly;  // the other names by which any aircraft knew or knows it
    // As the aircraft knows it that has heard of the last detection; not set if it is only in the findings.
    std::optional<Uav::Target> Target;
    double AgeS = std::numeric_limits<double>::quiet_NaN();  // since what said so came
    double UnseenS = 0;                                      // before that
    std::string ToldBy;
    // What came of it at the aircraft that got farthest; not set if none has taken it up.
    std::optional<FoundTarget> Found;
};

// In the order of their names. An aircraft that is gone goes on knowing a target by a name that the others
// have merged into another one since: what any aircraft calls a former name is one, unless another one denies
// it, or has a target of that name later.
std::vector<ListedTarget> ListTargets(const std::vector<SaidOfTargets> &said);

}  // namespace Ground
