// Literals that IDL and C++ write alike.
#pragma once

#include <string>

namespace RabitIdl
{

// A string literal with that content.
std::string Quote(const std::string &text);
// A floating-point literal: the fewest digits that restore the value, and a point or an exponent.
std::string Number(double value);

}  // namespace RabitIdl
