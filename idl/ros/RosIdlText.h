// IDL files of ROS 2, as rosidl makes them, for idlc.
#pragma once

#include <string>

namespace RabitIdl
{

// The same file, line by line, without what idlc 0.10.2 does not take:
// - typedefs of arrays (`double__36`), which each file of a package has for itself, are defined once;
// - `>>` that ends two sequences becomes `> >`;
// - names that IDL takes for keywords, in whatever case (`Char`, `INT8`), are escaped;
// - `@verbatim`, of which idlc only warns, is left out.
std::string RosIdlText(const std::string &text);

}  // namespace RabitIdl
