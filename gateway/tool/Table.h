#pragma once

#include <string>
#include <vector>

namespace Rabit::Tool
{

// Formats rows of cells as lines with columns, two blanks apart. Cells must be safe for a terminal
// (SafeText).
std::vector<std::string> TableLines(const std::vector<std::vector<std::string>> &rows);

// Writes a number by a format of printf, such as `%.2f Hz`; 47 characters at most.
std::string Formatted(const char *format, double value);

}  // namespace Rabit::Tool
