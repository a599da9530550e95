#pragma once

#include <string>
#include <vector>

#include "FleetSession.h"
#include "doctor/Finding.h"

// What is wrong with the fleet, by what its nodes say. Pure.
namespace Rabit::Tool::Doctor
{

// Who is there, what this program itself lacks, and nodes of one name.
std::vector<Finding> OfNodes(const std::vector<FleetSession::Node> &nodes, const Gateway::Fleet &fleet);
// Definitions of types that differ.
std::vector<Finding> OfTypes(const std::vector<FleetSession::Node> &nodes);
// Wall clocks that differ from this machine's.
std::vector<Finding> OfClocks(const std::vector<FleetSession::Node> &nodes, const Gateway::Fleet &fleet);
// Links that do not get on, by what the nodes at their ends say.
std::vector<Finding> OfLinks(const std::vector<FleetSession::Node> &nodes);
// Beats that were lost on the way.
std::vector<Finding> OfLosses(const std::vector<FleetSession::Node> &nodes);

}  // namespace Rabit::Tool::Doctor
