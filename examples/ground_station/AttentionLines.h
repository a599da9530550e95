// Problems that a person should know besides the table, as text: declined and failed commands, missing data
// of an aircraft, and a silent gateway of this ground station. Pure functions. Text that came from the
// network is made printable first.
#pragma once

#include "FleetTable.h"
#include "ground.idl.h"

#include <string>
#include <vector>

namespace Ground
{

// One line for each problem, in the order of the rows: missing data; a bad position; a low battery; a
// declined search area; a last command that was declined or may not have arrived; an aircraft that is back
// without orders. If the Fleet is too old, the first line says that this ground station's own gateway is
// silent.
std::vector<std::string> AttentionLines(const std::vector<FleetRow> &rows, const CommandList &commands,
                                        const CommandTally &tally, double fleetAgeS);

}  // namespace Ground
