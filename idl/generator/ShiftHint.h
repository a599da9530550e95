// idlc 0.10.2 takes the `>>` of `sequence<sequence<long>>` for a shift and reports only "syntax error".
#pragma once

#include <string>
#include <vector>

namespace RabitIdl
{

// Returns a line for each such place in a text, with its line number: `3: write "> >" ...`.
std::vector<std::string> ShiftHints(const std::string &text);

}  // namespace RabitIdl
