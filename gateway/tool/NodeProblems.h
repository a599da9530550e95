#pragma once

#include <rabit/gateway/Fleet.h>

#include <vector>

namespace Rabit::Tool
{

// The problems that the nodes themselves have, as they report them. `node` of each is the node that has it.
// If their texts have not come, or not all, a line tells how many there are.
std::vector<Gateway::Problem> ProblemsOfNodes(const Gateway::Fleet &fleet);

// True if the texts of all nodes that have problems have come.
bool AreProblemsKnown(const Gateway::Fleet &fleet);

}  // namespace Rabit::Tool
