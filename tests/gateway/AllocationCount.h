#pragma once

#include <cstddef>

namespace Rabit
{

// Calls of operator new so far, in a program that AllocationCount.cpp is a part of: it takes the place of
// operator new, which the sanitizers do as well. For programs that allocate on one thread.
std::size_t AllocationsSoFar();

}  // namespace Rabit
