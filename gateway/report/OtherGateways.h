#pragma once

#include <rabit/RabitWorkspace.h>

#include <string>

#include "gateway.idl.h"

namespace Rabit::OtherGateways
{

// Adds a problem for each node that another gateway of the workspace lists in its Fleet message, too.
// Mirrored messages of the two nodes have the same names here, and queue messages go through one gateway
// alone. `name` is the name of this gateway.
void AddSharedNodes(RabitWorkspace &workspace, const std::string &name, Gateway::Fleet &fleet);

}  // namespace Rabit::OtherGateways
