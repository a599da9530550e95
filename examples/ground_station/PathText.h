// How the way to an aircraft does, as text: the round trip there and back, and how many bytes a second of
// queue messages arrive there.
#pragma once

#include "FleetTable.h"

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// Columns for the end of the table, and how wide they are. The way to an aircraft that is not UP stands in
// parentheses, as everything that is old.
inline constexpr std::size_t PathColumnsWidth = 17;
std::string PathHeading();
std::string PathColumns(const FleetRow &row);

// For a table too narrow for these columns: the same below it, of the aircraft of which anything is known.
std::vector<std::string> PathLines(const std::vector<FleetRow> &rows, std::size_t columns);

// For a line of a log: `round trip 12 ms, delivers 3.2 kB/s`. Empty if nothing is known.
std::string PathLogText(const FleetRow &row);

}  // namespace Ground
