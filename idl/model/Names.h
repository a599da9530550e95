// Finds the names of an IDL file that cannot become C++ names.
#pragma once

#include <string>
#include <vector>

namespace RabitIdl
{

// The reason why a name cannot be used in C++ (a keyword, a reserved name, a macro); empty if it can.
std::string WhyNotCpp(const std::string &name);
// True if message classes already have a member of that name, from Rabit::RabitMessage or from the
// generator.
bool IsMessageMember(const std::string &name);
// True if the generator itself declares that name beside each type (`ToString`).
bool IsGeneratorName(const std::string &name);
// True if a name is like those of ROS 2's array typedefs, such as `double__36`, which C++ reserves.
bool IsTypedefOfRos(const std::string &name);
// True if a name is a keyword of IDL, in any case, and so needs a leading underscore in IDL.
bool IsIdlKeyword(const std::string &name);
// `A::B::Name`, and `::A::B::Name`.
std::string ScopedName(const std::vector<std::string> &scope, const std::string &name);
std::string CppScopedName(const std::vector<std::string> &scope, const std::string &name);

}  // namespace RabitIdl
