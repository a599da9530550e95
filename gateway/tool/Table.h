#pragma once

#include <string>
#include <vector>

namespace Rabit::Tool
{

// Formats rows of cells as lines with columns, two blanks apart. Cells must be safe for a terminal
// (SafeText).
std::vector<std::string> TableLines(const std::vector<std::vector<std::string>> &rows);

// Returns names for a cell, one blank apart: up to eight, or the first six as in `uav1 uav2 ... and 34 more`.
// `-` if there are none.
std::string NamesText(const std::vector<std::string> &names);

// Returns a number for people with `digits` digits behind the point, `-` if it is not known.
std::string NumberText(double number, int digits, const char *unit = "");

}  // namespace Rabit::Tool
