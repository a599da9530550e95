#pragma once

#include <rabit/RabitWorkspace.h>

#include <string>

#include "gateway.idl.h"

namespace Rabit::OtherGateways
{

// Adds a problem for each node that another gateway of the workspace knows as well, as its own message tells:
// mirrored messages of the two have the same names here, and queue messages go through one of them. `name` is
// this gateway's.
void AddSharedNodes(RabitWorkspace &workspace, const std::string &name, Gateway::Fleet &fleet);

}  // namespace Rabit::OtherGateways
