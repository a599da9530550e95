#pragma once

#include "CommonOptions.h"
#include "FleetSession.h"
#include "RosNodes.h"

namespace Rabit::Tool
{

// Asks all live nodes for the topics of foreign programs that they read or write, and shows the topics with
// their states: a table, or an object for each. Nodes that have not answered within 2 s, or within --wait if
// it is given, are named on standard error. Returns false if standard output is closed.
bool ShowForeignTopics(FleetSession &session, const CommonOptions &options);

// Shows the participants of ROS 2 and the nodes of each: a table, or an object for each. Returns false if
// standard output is closed.
bool ShowRosNodes(const RosNodes::Names &programs, bool json);

}  // namespace Rabit::Tool
