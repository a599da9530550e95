#pragma once

#include "FleetTable.h"

#include <rabit/gateway/Fleet.h>

#include <cstring>
#include <string>

namespace Ground
{

// A Fleet older than this tells nothing of the present any more: the gateway posts it every second.
inline constexpr double FleetFreshS = 3.0;

// What the gateway knows of that node; null if nothing.
const Rabit::Gateway::NodeStatus *StatusOf(const Rabit::Gateway::Fleet &fleet, const std::string &node);

// How to show that node. A node that was UP in a Fleet of that age, when that is too old, is shown as STALE:
// nobody knows whether it is there.
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
