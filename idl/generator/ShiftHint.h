// idlc 0.10.2 takes the `>>` of `sequence<sequence<long>>` for a shift and says no more than "syntax error".
#pragma once

#include <string>
#include <vector>

namespace RabitIdl
{

// One line for each such place in a text, each with its number in the text: `3: write "> >" ...`.
std::vector<std::string> ShiftHints(const std::string &text);

}  // namespace RabitIdl
