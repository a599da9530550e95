// Counts the calls of malloc and its relatives by taking their place, so calls of the vendors' libraries
// count too. Linked into every contestant alike, and into tests. Sanitizers bring an allocator of their own:
// with them nothing is counted.
#include "../../sanitizers/Sanitized.h"
#include "Usage.h"

#include <atomic>
#include <cerrno>
#include <cstddef>

namespace
{

// NOLINTNEXTLINE: counted for the whole process
std::atomic<std::uint64_t> allocations{0};

}  // namespace

namespace Rabit::Bench
{

std::uint64_t AllocationsSoFar()
{
    return allocations.load(std::memory_order_relaxed);
}

}  // namespace Rabit::Bench

#ifndef RABIT_SANITIZED

extern "C"
{
    void *__libc_malloc(std::size_t size);
    void *__libc_calloc(std::size_t count, std::size_t size);
    void *__libc_realloc(void *memory, std::size_t size);
    void *__libc_memalign(std::size_t alignment, std::size_t size);

    void *malloc(std::size_t size) noexcept
    {
        allocations.fetch_add(1, std::memory_order_relaxed);
        return __libc_malloc(size);
    }

    void *calloc(std::size_t count, std::size_t size) noexcept
    {
        allocations.fetch_add(1, std::memory_order_relaxed);
        return __libc_calloc(count, size);
    }

    void *realloc(void *memory, std::size_t size) noexcept
    {
        allocations.fetch_add(1, std::memory_order_relaxed);
        return __libc_realloc(memory, size);
    }

    void *aligned_alloc(std::size_t alignment, std::size_t size) noexcept
    {
        allocations.fetch_add(1, std::memory_order_relaxed);
        return __libc_memalign(alignment, size);
    }

    int posix_memalign(void **memory, std::size_t alignment, std::size_t size) noexcept
    {
        allocations.fetch_add(1, std::memory_order_relaxed);
        *memory = __libc_memalign(alignment, size);
        return *memory == nullptr ? ENOMEM : 0;
    }
}

#endif
