#pragma once

#include <chrono>
#include <cstdint>

namespace Rabit::Simulated
{

// SplitMix64 (G. Steele, D. Lea, C. Flood: Fast splittable pseudorandom number generators, 2014). The
// distributions of <random> differ between standard libraries, and a seed must replay everywhere.
class Random
{
public:
    explicit Random(std::uint64_t seed) : _state(seed) {}

    std::uint64_t Next()
    {
        std::uint64_t mixed = (_state += 0x9E3779B97F4A7C15u);
        mixed = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9u;
        mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBu;
        return mixed ^ (mixed >> 31);
    }

    // In [0, 1).
    double Fraction() { return static_cast<double>(Next() >> 11) * 0x1.0p-53; }

    // Draws no number if the answer is certain, so that a disabled fault costs nothing.
    bool Happens(double probability)
    {
        return probability > 0.0 && (probability >= 1.0 || Fraction() < probability);
    }

    std::chrono::nanoseconds PartOf(std::chrono::nanoseconds whole)
    {
        if (whole.count() <= 0)
        {
            return std::chrono::nanoseconds(0);
        }
        return std::chrono::nanoseconds(
            static_cast<std::int64_t>(Fraction() * static_cast<double>(whole.count())));
    }

private:
    std::uint64_t _state;
};

}  // namespace Rabit::Simulated
