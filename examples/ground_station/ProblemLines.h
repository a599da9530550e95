// What keeps data from flowing now, as text: pure functions from the gateway's list to lines. Text that came
// from the network is made printable first.
#pragma once

#include "FleetTable.h"

#include <rabit/gateway/Fleet.h>

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// The rest is counted.
inline constexpr std::size_t ProblemsOnScreen = 5;

// For a screen: how many there are and the first few by name. Nothing if there are none. The list is of that
// age; if that is too old, the lines say so.
std::vector<TableLine> ProblemTableLines(const std::vector<Rabit::Gateway::Problem> &problems,
                                         double fleetAgeS);

// For a log: the same in one line, without the reasons, which the gateway logs. Empty if there are none.
std::string ProblemLogLine(const std::vector<Rabit::Gateway::Problem> &problems, double fleetAgeS,
                           double elapsedS);

}  // namespace Ground
