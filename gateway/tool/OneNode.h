#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "CommonOptions.h"
#include "FleetSession.h"

namespace Rabit::Tool
{

// Functions of the commands about one node.

// The configuration of a tool that requests no announcements.
GatewayConfig ConfigWithoutOffers(const CommonOptions &options);

// Waits until the node is heard, for --wait at most, and without --wait only until all
// nodes are heard. Returns Good, or reports that it is not there and returns the exit code.
int WaitForNode(FleetSession &session, const CommonOptions &options, const std::string &node);

// Requests a report, and waits for it for 10 s, which is long unless the channel is full. Empty: reports that
// the node does not answer.
std::optional<FleetExplorer::Answer> Request(FleetSession &session, const std::string &node,
                                             FleetExplorer::Report what, std::uint32_t argument = 0);

}  // namespace Rabit::Tool
