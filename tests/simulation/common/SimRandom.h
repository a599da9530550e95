#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace Rabit::Sim
{

// Random numbers that are the same on every machine and with every standard library: splitmix64.
class SimRandom
{
public:
    explicit SimRandom(std::uint64_t seed) : _state(seed) {}

    std::uint64_t Next()
    {
        _state += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = _state;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }
    // Returns a number from 0 to 1, 1 excluded.
    double Unit() { return static_cast<double>(Next() >> 11) * 0x1.0p-53; }
    bool Chance(double probability) { return Unit() < probability; }
    // Returns a number from low to high, both included.
    std::int64_t Between(std::int64_t low, std::int64_t high)
    {
        return low + static_cast<std::int64_t>(Next() % static_cast<std::uint64_t>(high - low + 1));
    }
    // Returns a number from low to high, each order of magnitude equally likely. low > 0.
    std::int64_t LogBetween(std::int64_t low, std::int64_t high)
    {
        const double ratio = static_cast<double>(high) / static_cast<double>(low);
        return static_cast<std::int64_t>(static_cast<double>(low) * std::pow(ratio, Unit()));
    }
    // The same for times, in nanoseconds.
    std::chrono::nanoseconds Between(std::chrono::nanoseconds low, std::chrono::nanoseconds high)
    {
        return std::chrono::nanoseconds(Between(low.count(), high.count()));
    }
    std::chrono::nanoseconds LogBetween(std::chrono::nanoseconds low, std::chrono::nanoseconds high)
    {
        return std::chrono::nanoseconds(LogBetween(low.count(), high.count()));
    }
    // Returns one of `count` positions.
    std::size_t Index(std::size_t count)
    {
        return static_cast<std::size_t>(Between(0, static_cast<std::int64_t>(count) - 1));
    }

private:
    std::uint64_t _state;
};

}  // namespace Rabit::Sim
