#pragma once

#include <cstddef>

namespace Rabit
{

// Returns the calls of operator new so far. AllocationCount.cpp, linked into the program, replaces operator
// new, which the sanitizers do as well. For programs that allocate on one thread.
std::size_t AllocationsSoFar();

}  // namespace Rabit
