// What the radio of this node does, as text: pure functions to lines. Text that came from the network is made
// printable first.
#pragma once

#include "FleetTable.h"
#include "RadioWatch.h"

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// Of what is held back; the rest is counted.
inline constexpr std::size_t HeldOnScreen = 5;

// For a screen: one line for a radio that nothing limits; else what limits it, what each class uses of it,
// and what is held back by name. Nothing before the first Fleet. What is told is of that age; if that is too
// old, the lines say so.
std::vector<TableLine> RadioTableLines(const RadioUse &use, double fleetAgeS, std::size_t columns);

// For a log: the same in one line. Empty before the first Fleet.
std::string RadioLogLine(const RadioUse &use, double fleetAgeS, double elapsedS);

}  // namespace Ground
