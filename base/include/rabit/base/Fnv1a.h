#pragma once

#include <cstdint>

namespace Rabit
{

// Computes the FNV-1a hash (Fowler, Noll and Vo, 64 bits): the same in every process and on every host.
// Detects accidental differences, not intended ones: an attacker can easily find two inputs with one hash.
class Fnv1a
{
public:
    // `sum`: to go on from an earlier hash.
    explicit constexpr Fnv1a(std::uint64_t sum = 0xcbf29ce484222325) : _sum(sum) {}

    // Adds a range of bytes, or of characters.
    template <typename Bytes>
    constexpr Fnv1a &Add(const Bytes &bytes)
    {
        for (const auto each : bytes)
        {
            static_assert(sizeof each == 1);
            AddByte(static_cast<std::uint8_t>(each));
        }
        return *this;
    }
    constexpr Fnv1a &AddByte(std::uint8_t value)
    {
        _sum = (_sum ^ value) * 0x100000001b3;
        return *this;
    }
    // Adds eight bytes, the lowest first.
    constexpr Fnv1a &AddNumber(std::uint64_t number)
    {
        for (int shift = 0; shift < 64; shift += 8)
        {
            AddByte(static_cast<std::uint8_t>(number >> shift));
        }
        return *this;
    }

    constexpr std::uint64_t Sum() const { return _sum; }
    // The two halves of the sum in 32 bits.
    constexpr std::uint32_t Folded() const { return static_cast<std::uint32_t>(_sum ^ (_sum >> 32)); }

private:
    std::uint64_t _sum;
};

}  // namespace Rabit
