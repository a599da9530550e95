// What a person should know of the aircraft beside their table, as text: what each declines or has not done,
// what is missing of it, and what of this ground station is silent. Pure functions. Text that came from the
// network is made printable first.
#pragma once

#include "FleetTable.h"
#include "ground.idl.h"

#include <string>
#include <vector>

namespace Ground
{

// One line for each thing, in the order of the rows: what is missing; the search area, if it is declined; the
// last command, if it was declined or has not arrived for certain; that it is back without orders. Before all
// others, if what the states rest on is too old, that this ground station's own gateway is silent.
std::vector<std::string> AttentionLines(const std::vector<FleetRow> &rows, const CommandList &commands,
                                        const CommandTally &tally, double fleetAgeS);

}  // namespace Ground
