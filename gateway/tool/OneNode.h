#pragma once

#include <string>

#include "CommonOptions.h"
#include "FleetSession.h"

namespace Rabit::Tool
{

// Functions of the commands about one node.

// The configuration of a tool that requests no announcements.
GatewayConfig ConfigWithoutOffers(const CommonOptions &options);

// Waits until the node is heard, for --wait seconds at most, and without --wait for 1.5 s if others are
// heard. Returns Good, or reports that it is not there and returns the exit code.
int WaitForNode(FleetSession &session, const CommonOptions &options, const std::string &node);

// The node; null if it is not known.
const FleetSession::Node *FindNode(const std::vector<FleetSession::Node> &nodes, const std::string &node);

}  // namespace Rabit::Tool
