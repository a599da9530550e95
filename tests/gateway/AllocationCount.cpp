#include "AllocationCount.h"

#include <cstdlib>
#include <new>

namespace
{

// NOLINTNEXTLINE: counted for the whole program
std::size_t allocations = 0;

}  // namespace

std::size_t Rabit::AllocationsSoFar()
{
    return allocations;
}

void *operator new(std::size_t size)
{
    ++allocations;
    if (void *memory = std::malloc(size))
    {
        return memory;
    }
    throw std::bad_alloc();
}

// GCC takes the two operators for mismatched where it inlines one of them alone.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void operator delete(void *memory) noexcept
{
    std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept
{
    std::free(memory);
}
