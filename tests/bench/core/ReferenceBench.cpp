// The costs of the computer itself, measured in the same run. The aims are multiples of these.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <vector>

namespace
{

void LockAndUnlock(benchmark::State &state)
{
    std::mutex mutex;
    for (auto _ : state)
    {
        mutex.lock();
        benchmark::ClobberMemory();
        mutex.unlock();
    }
}
BENCHMARK(LockAndUnlock)->Name("Reference/LockUnlock");

void CopySharedPointer(benchmark::State &state)
{
    const auto pointer = std::make_shared<int>(1);
    for (auto _ : state)
    {
        std::shared_ptr<int> copy = pointer;
        benchmark::DoNotOptimize(copy);
    }
}
BENCHMARK(CopySharedPointer)->Name("Reference/SharedPtrCopy");

void ReadClock(benchmark::State &state)
{
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(std::chrono::steady_clock::now());
    }
}
BENCHMARK(ReadClock)->Name("Reference/ClockRead");

void CopyMegabyte(benchmark::State &state)
{
    const std::vector<std::uint8_t> from(std::size_t{1} << 20, 1);
    std::vector<std::uint8_t> to(from.size());
    for (auto _ : state)
    {
        std::memcpy(to.data(), from.data(), from.size());
        benchmark::ClobberMemory();
    }
}
BENCHMARK(CopyMegabyte)->Name("Reference/Memcpy1MB");

}  // namespace
