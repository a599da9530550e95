#pragma once

#include "FleetTable.h"

#include <rabit/gateway/Fleet.h>

#include <cstring>
#include <string>

namespace Ground
{

// A Fleet older than this is out of date: the gateway posts it every second.
inline constexpr double FleetFreshS = 3.0;

// The gateway's status of that node; null if there is none.
const Rabit::Gateway::NodeStatus *StatusOf(const Rabit::Gateway::Fleet &fleet, const std::string &node);

// The state to show for that node. If the Fleet is too old, a node that was UP in it is shown as STALE.
RowState StateOf(const Rabit::Gateway::Fleet &fleet, double fleetAgeS, const std::string &node);

// Names in the order that people expect: uav2 before uav10.
struct NaturalOrder
{
    bool operator()(const std::string &a, const std::string &b) const
    {
        return strverscmp(a.c_str(), b.c_str()) < 0;
    }
};

}  // namespace Ground
