// Which names of an IDL file cannot become C++ names.
#pragma once

#include <string>
#include <vector>

namespace RabitIdl
{

// Why a name cannot be used in C++ (a keyword, a reserved name, a macro of the standard headers); empty if it
// can.
std::string WhyNotCpp(const std::string &name);
// Whether a message class has a member of that name already, from Rabit::RabitMessage or from the generator.
bool IsMessageMember(const std::string &name);
// Whether the generator itself declares that name beside each type (`ToString`).
bool IsGeneratorName(const std::string &name);
// Whether a typedef has a name like those that ROS 2 gives to arrays, as `double__36`, which C++ reserves.
bool IsTypedefOfRos(const std::string &name);
// Whether a name is a keyword of IDL, in any case, and must be written with a leading underscore in IDL.
bool IsIdlKeyword(const std::string &name);
// `A::B::Name`, and `::A::B::Name`.
std::string ScopedName(const std::vector<std::string> &scope, const std::string &name);
std::string CppScopedName(const std::vector<std::string> &scope, const std::string &name);

}  // namespace RabitIdl
