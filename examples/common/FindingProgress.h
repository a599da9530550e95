// The progress of a finding, to compare two findings of one target.
#pragma once

#include "uav.idl.h"

#include <utility>

namespace Common
{

// Greater for findings that got farther. A rejected finding is least; within one stage, the one followed
// longer is greater.
std::pair<int, double> ProgressOf(const Uav::Finding &finding);

}  // namespace Common
