// 64-bit FNV-1a hash: detects accidental differences, not intended ones.
#pragma once

#include <cstdint>
#include <span>

namespace Rabit::Rtps
{

class Fnv
{
public:
    void Add(std::span<const std::uint8_t> bytes)
    {
        for (const std::uint8_t byte : bytes)
        {
            AddByte(byte);
        }
    }
    void AddByte(std::uint8_t byte) { _sum = (_sum ^ byte) * 1099511628211u; }
    void AddNumber(std::uint64_t number)
    {
        for (int shift = 0; shift < 64; shift += 8)
        {
            AddByte(static_cast<std::uint8_t>(number >> shift));
        }
    }

    std::uint64_t Sum() const { return _sum; }

private:
    std::uint64_t _sum = 14695981039346656037u;
};

}  // namespace Rabit::Rtps
