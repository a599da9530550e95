#pragma once

#include <string>
#include <vector>

namespace Rabit::Tool
{

// Formats rows of cells as lines with columns, two blanks apart. Cells must be safe for a terminal
// (SafeText).
std::vector<std::string> TableLines(const std::vector<std::vector<std::string>> &rows);

}  // namespace Rabit::Tool
