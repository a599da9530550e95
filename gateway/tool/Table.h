#pragma once

#include <string>
#include <vector>

namespace Rabit::Tool
{

// Rows of cells as lines with columns, two blanks apart. Cells are for a terminal already (SafeText).
std::vector<std::string> TableLines(const std::vector<std::vector<std::string>> &rows);

}  // namespace Rabit::Tool
