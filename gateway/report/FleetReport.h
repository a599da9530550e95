#pragma once

#include <rabit/transport/Transport.h>

#include <chrono>
#include <string_view>
#include <vector>

#include "gateway.idl.h"
#include "paths/PeersOverPaths.h"

namespace Rabit::FleetReport
{

// Fills the list of nodes: states, times and reasons from the peer table, sums from the topics and links that
// are already in the message.
void FillNodes(const PeersOverPaths &peers, std::chrono::nanoseconds now, Gateway::Fleet &fleet);

// Seconds since its last beat arrived, and of a beat and its echo: NaN while unknown.
double LastHeardSeconds(const PeerTable::Peer &peer, std::chrono::nanoseconds now);
double RoundTripSeconds(const PeerTable::Peer &peer);

// Returns the row of that node, by binary search; null if there is none. Only after FillNodes.
Gateway::NodeStatus *NodeIn(Gateway::Fleet &fleet, std::string_view node);

// Adds a problem for each name that two live nodes share.
void AddNameProblems(const PeersOverPaths &peers, Gateway::Fleet &fleet);

// Adds a problem for each network setting that is wrong on this host now.
void AddNetworkProblems(const std::vector<SettingsProblem> &problems, Gateway::Fleet &fleet);

}  // namespace Rabit::FleetReport
