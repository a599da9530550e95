// How much memory this process holds.
#pragma once

#include <malloc.h>
#include <unistd.h>

#include <cstddef>
#include <fstream>

#include "../../sanitizers/Sanitized.h"

namespace Rabit::Conformance
{

#ifdef RABIT_SANITIZED
constexpr bool MemoryIsNotGivenBack = true;
#else
constexpr bool MemoryIsNotGivenBack = false;
#endif

// Returns the resident memory of this process, in MiB, after the allocator gave back its free memory.
inline double MemoryInMegabytes()
{
    ::malloc_trim(0);
    std::ifstream file("/proc/self/statm");
    double all = 0;
    double resident = 0;
    file >> all >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

// Returns the bytes that this process has allocated and not freed. Unlike its resident memory, this does not
// depend on how the threads' allocations lie between each other.
inline std::size_t HeapInUse()
{
    const auto info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
}

}  // namespace Rabit::Conformance
