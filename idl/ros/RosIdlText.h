// Adapts IDL files of ROS 2, as rosidl makes them, to idlc.
#pragma once

#include <string>

namespace RabitIdl
{

// Returns the same file, line by line, without the constructs that idlc 0.10.2 refuses:
// - typedefs of arrays (`double__36`), which each file of a package repeats, are defined once;
// - `>>` that ends two sequences becomes `> >`;
// - names that IDL takes for keywords, in any case (`Char`, `INT8`), are escaped;
// - `@verbatim`, which only causes a warning of idlc, is left out.
std::string RosIdlText(const std::string &text);

}  // namespace RabitIdl
