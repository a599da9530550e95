#pragma once

#include <rabit/RabitWorkspace.h>

#include <vector>

#include "gateway.idl.h"

namespace Rabit::ManagerTroubles
{

// Returns a problem for each manager of this process that hangs or fails.
std::vector<Gateway::Problem> ProblemsOf(const std::vector<ManagerTrouble> &troubles);

}  // namespace Rabit::ManagerTroubles
