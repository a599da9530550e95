// Memory that this process has allocated.
#pragma once

#include <malloc.h>

#include <cstddef>

#include "../../sanitizers/Sanitized.h"

namespace Rabit::Conformance
{

#ifdef RABIT_SANITIZED
constexpr bool MemoryIsNotGivenBack = true;
#else
constexpr bool MemoryIsNotGivenBack = false;
#endif

// Returns the bytes that this process has allocated and not freed. Unlike its resident memory, this does not
// depend on how the threads' allocations lie between each other.
inline std::size_t HeapInUse()
{
    const auto info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
}

}  // namespace Rabit::Conformance
