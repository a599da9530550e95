// The targets of the search as text: pure functions.
#pragma once

#include "uav.idl.h"

#include <string>
#include <vector>

namespace Ground
{

// A target that an aircraft has found.
struct FoundTarget
{
    std::string Aircraft;
    Uav::Finding Finding;
    std::vector<Uav::TargetName> Formerly{};  // other names of it
};

std::string ToText(Uav::TargetStage stage);

// The name of the target in the fleet: `uav1/3`.
std::string NameOf(const Uav::TargetName &name);
std::string NameOf(const FoundTarget &target);

// One line of ASCII, for instance `target uav1/3   TRACKED     47.39771     8.54560  validated by uav2,
// followed for 12 s`.
std::string TargetLine(const FoundTarget &target);

// True if the search is done with the target: found by one aircraft, validated by another, followed.
bool IsTracked(const FoundTarget &target);

}  // namespace Ground
