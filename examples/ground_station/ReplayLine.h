#pragma once

#include <rabit/gateway/Fleet.h>

#include <string>
#include <vector>

namespace Ground
{

// The present nodes that play a recording.
std::vector<std::string> ReplayedNodes(const Rabit::Gateway::Fleet &fleet);
// A line that says that the shown data is a replay; empty if it is live.
std::string ReplayLine(const Rabit::Gateway::Fleet &fleet);

}  // namespace Ground
