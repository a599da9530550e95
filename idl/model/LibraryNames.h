// Names that the libraries of C and C++ have taken.
#pragma once

#include <string>

namespace RabitIdl
{

// True if the name is a macro in the headers that generated code includes. No name of an IDL file can be one.
bool IsLibraryMacro(const std::string &name);
// True if the C library, or another library that generated code includes, declares the name outside of all
// namespaces. Names in a module may be the same.
bool IsLibraryName(const std::string &name);

}  // namespace RabitIdl
