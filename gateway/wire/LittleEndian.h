#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Unsigned numbers as bytes, the lowest first.
namespace Rabit::LittleEndian
{

template <typename Number>
void Put(Number number, std::vector<std::uint8_t> &bytes)
{
    for (std::size_t i = 0; i < sizeof number; ++i)
    {
        bytes.push_back(static_cast<std::uint8_t>(number >> 8 * i));
    }
}

// Takes a number from the front; there must be enough bytes.
template <typename Number>
Number Take(std::span<const std::uint8_t> &bytes)
{
    Number number = 0;
    for (std::size_t i = 0; i < sizeof number; ++i)
    {
        number = static_cast<Number>(number | static_cast<Number>(bytes[i]) << 8 * i);
    }
    bytes = bytes.subspan(sizeof number);
    return number;
}

}  // namespace Rabit::LittleEndian
