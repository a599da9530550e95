#pragma once

#include <set>
#include <string>
#include <vector>

#include "FleetSession.h"
#include "doctor/Finding.h"

// Problems of the fleet, by what its nodes say. Pure.
namespace Rabit::Tool::Doctor
{

// Lists live nodes, and finds nodes of one name, missing announcements and problems of this program.
std::vector<Finding> OfNodes(const std::vector<FleetSession::Node> &nodes, const Gateway::Fleet &fleet);
// Finds paths of this program on which nobody was heard in that many seconds, if somebody was on another one.
std::vector<Finding> OfPaths(const Gateway::Fleet &fleet, double listened);
// Returns the nodes that hear this program: they echo its beats.
std::set<std::string> NodesThatHear(const Gateway::Fleet &fleet);
// Finds types with different definitions.
std::vector<Finding> OfTypes(const std::vector<FleetSession::Node> &nodes);
// Finds wall clocks that differ from this machine's.
std::vector<Finding> OfClocks(const std::vector<FleetSession::Node> &nodes, const Gateway::Fleet &fleet);
// Finds links that are blocked or in doubt, by what the nodes at their ends say. Names at most three full
// queues of a node, the longest first, once the node's own problems have come.
std::vector<Finding> OfLinks(const std::vector<FleetSession::Node> &nodes, const Gateway::Fleet &fleet);
// Finds beats that were lost on the way.
std::vector<Finding> OfLosses(const std::vector<FleetSession::Node> &nodes);

}  // namespace Rabit::Tool::Doctor
