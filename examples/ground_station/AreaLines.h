// The outcome of search areas as text: pure functions. Text that came from the network is made printable
// first.
#pragma once

#include "FleetTable.h"
#include "ground.idl.h"

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// Number of aircraft with that outcome.
std::size_t CountOf(const AreaStatus &area, AreaProgress progress);

// True if all aircraft fly it. True if there are no aircraft.
bool IsFlownByAll(const AreaStatus &area);

// The outcome at all aircraft: `2 of 3 fly area 5; declined by uav2; not answered by uav3`.
std::string AreaText(const AreaStatus &area);

// The line about the wanted area, with a warning unless all aircraft fly it; none if no area was given.
std::vector<TableLine> AreaTableLines(const AreaList &areas);

}  // namespace Ground
