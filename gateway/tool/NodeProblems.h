#pragma once

#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/FleetExplorer.h>

#include <vector>

namespace Rabit::Tool
{

// The problems that the nodes themselves have, as they report them. `node` of each is the node that has it.
// If their texts have not come, or not all, a line tells how many there are.
std::vector<Gateway::Problem> ProblemsOfNodes(const Gateway::Fleet &fleet);

// For people: a row for each cause. Problems `node NAME` with the same reason become one, `nodes NAME NAME`
// without a node, where the first of them was. All others stay as they are.
std::vector<Gateway::Problem> Joined(const std::vector<Gateway::Problem> &problems);

// True if all live nodes have told their problems, or that they have none.
bool AreProblemsKnown(const std::vector<FleetExplorer::Node> &nodes);

}  // namespace Rabit::Tool
