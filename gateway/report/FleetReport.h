#pragma once

#include <rabit/transport/Transport.h>

#include <chrono>
#include <string_view>
#include <vector>

#include "gateway.idl.h"
#include "presence/PeerTable.h"

namespace Rabit::FleetReport
{

// Fills the list of nodes: states, times and reasons from the peer table, sums from the topics and links that
// are already in the message.
void FillNodes(const PeerTable &peers, std::chrono::nanoseconds now, Gateway::Fleet &fleet);

// The row of that node, after FillNodes; null if there is none. Takes a binary search.
Gateway::NodeStatus *NodeIn(Gateway::Fleet &fleet, std::string_view node);

// Problems with names that two live nodes share.
void AddNameProblems(const PeerTable &peers, Gateway::Fleet &fleet);

// What of the network is missing that the configuration asks for.
void AddNetworkProblems(const std::vector<SettingsProblem> &problems, Gateway::Fleet &fleet);

}  // namespace Rabit::FleetReport
