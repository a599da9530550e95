// How much memory this process holds.
#pragma once

#include <malloc.h>
#include <unistd.h>

#include <cstddef>
#include <fstream>

namespace Rabit::Conformance
{

// The sanitizers keep freed memory for a while, or take several bytes for each byte in use.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
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
