// How far a finding got, to compare two of one target.
#pragma once

#include "uav.idl.h"

#include <utility>

namespace Common
{

// The farther it got the greater: what was rejected is least; of two in one stage the one that was followed
// longer.
std::pair<int, double> ProgressOf(const Uav::Finding &finding);

}  // namespace Common
