#pragma once

#include <rabit/gateway/Fleet.h>

#include <string>
#include <vector>

namespace Ground
{

// The nodes that are there and play what was recorded before.
std::vector<std::string> ReplayedNodes(const Rabit::Gateway::Fleet &fleet);
// Says that what is shown is not live; empty if it is.
std::string ReplayLine(const Rabit::Gateway::Fleet &fleet);

}  // namespace Ground
