// The gateway's current problems as text: pure functions from its list to lines. Text that came from the
// network is made printable first.
#pragma once

#include "FleetTable.h"

#include <rabit/gateway/Fleet.h>

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// Problems shown on the screen; the others are counted.
inline constexpr std::size_t ProblemsOnScreen = 5;

// The problems that this node's gateway knows, and one row for each node that reports problems of its own.
std::vector<Rabit::Gateway::Problem> AllProblems(const Rabit::Gateway::Fleet &fleet);

// For a screen: the number of problems, and the first few by name. Empty if there are none. If the list, of
// the given age, is too old, the lines say so.
std::vector<TableLine> ProblemTableLines(const std::vector<Rabit::Gateway::Problem> &problems,
                                         double fleetAgeS);

// For a log: the same in one line, without the reasons, which the gateway logs. Empty if there are none.
std::string ProblemLogLine(const std::vector<Rabit::Gateway::Problem> &problems, double fleetAgeS,
                           double elapsedS);

}  // namespace Ground
