// The state of this node's radio as text: pure functions to lines. Text that came from the network is made
// printable first.
#pragma once

#include "FleetTable.h"
#include "RadioWatch.h"

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// Number of held-back streams and links shown; the others are counted.
inline constexpr std::size_t HeldOnScreen = 5;

// For a screen: one line if nothing limits the radio; otherwise the limit, the use by each class, and by
// name the streams and links that are held back. Empty before the first Fleet. If the Fleet, of the given
// age, is too old, the lines say so.
std::vector<TableLine> RadioTableLines(const RadioUse &use, double fleetAgeS, std::size_t columns);

// For a log: the same in one line. Empty before the first Fleet.
std::string RadioLogLine(const RadioUse &use, double fleetAgeS, double elapsedS);

}  // namespace Ground
