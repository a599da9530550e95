// The path to an aircraft as text: the round trip, and the bytes a second of queue messages that arrive
// there.
#pragma once

#include "FleetTable.h"

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// Columns for the end of the table, and their width. If the aircraft is not UP, the values are in
// parentheses, like all old values.
inline constexpr std::size_t PathColumnsWidth = 17;
std::string PathHeading();
std::string PathColumns(const FleetRow &row);

// For a table too narrow for these columns: lines below it, for the aircraft with known values.
std::vector<std::string> PathLines(const std::vector<FleetRow> &rows, std::size_t columns);

// For a line of a log: `round trip 12 ms, delivers 3.2 kB/s`. Empty if nothing is known.
std::string PathLogText(const FleetRow &row);

}  // namespace Ground
