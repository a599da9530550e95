// The fuzzer's entry of each target. An input may cost no more than its bytes explain: memory that is
// allocated for it in all, allocations, and processor time.
#include <time.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "Input.h"

extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*allocated)(const volatile void *,
                                                                           std::size_t),
                                                         void (*freed)(const volatile void *));

namespace
{

// The costs of an input beyond its bytes: a target makes the objects that parse anew for each one.
constexpr std::uint64_t FreeBytes = 500'000;
constexpr std::uint64_t FreeAllocations = 5'000;
constexpr double FreeSeconds = 0.02;
// For each byte.
constexpr std::uint64_t MostBytes = 1'000;
constexpr std::uint64_t MostAllocations = 25;
constexpr double MostSeconds = 50e-6;
// Processor time is judged by the fastest of this many runs: other programs use the same caches.
constexpr int Tries = 3;

thread_local std::uint64_t bytes = 0;
thread_local std::uint64_t allocations = 0;

void Allocated(const volatile void * /*memory*/, std::size_t size)
{
    bytes += size;
    ++allocations;
}
void Freed(const volatile void * /*memory*/) {}

double Seconds()
{
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void Judge(const char *what, double taken, double most)
{
    if (taken > most)
    {
        std::fprintf(stderr, "the input takes %g %s; its bytes explain %g\n", taken, what, most);
        std::abort();
    }
}

// The costliest inputs so far, for a person who sets the limits. Told at the end if FUZZ_COSTS is set.
struct Costs
{
    double Bytes = 0;
    double Allocations = 0;
    double Seconds = 0;

    ~Costs()
    {
        if (std::getenv("FUZZ_COSTS") != nullptr)
        {
            std::fprintf(stderr,
                         "costliest: %.3f of the bytes, %.3f of the allocations, %.3f of the time allowed\n",
                         Bytes, Allocations, Seconds);
        }
    }
};

Costs costs;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
    static const int installed = __sanitizer_install_malloc_and_free_hooks(&Allocated, &Freed);
    static const int warm = Fuzz::OneInput(data, size);  // makes what is made once
    static_cast<void>(installed);
    static_cast<void>(warm);
    const auto length = static_cast<double>(size);
    const double mostBytes = static_cast<double>(FreeBytes) + static_cast<double>(MostBytes) * length;
    const double mostAllocations =
        static_cast<double>(FreeAllocations) + static_cast<double>(MostAllocations) * length;
    const double mostSeconds = FreeSeconds + MostSeconds * length;
    double fastest = 0;
    for (int run = 0; run < Tries && (run == 0 || fastest > mostSeconds); ++run)
    {
        bytes = 0;
        allocations = 0;
        const double begin = Seconds();
        Fuzz::OneInput(data, size);
        const double taken = Seconds() - begin;
        fastest = run == 0 ? taken : std::min(fastest, taken);
        const auto allocated = static_cast<double>(bytes);
        const auto count = static_cast<double>(allocations);
        costs.Bytes = std::max(costs.Bytes, allocated / mostBytes);
        costs.Allocations = std::max(costs.Allocations, count / mostAllocations);
        Judge("bytes", allocated, mostBytes);
        Judge("allocations", count, mostAllocations);
    }
    costs.Seconds = std::max(costs.Seconds, fastest / mostSeconds);
    Judge("seconds of a processor", fastest, mostSeconds);
    return 0;
}
