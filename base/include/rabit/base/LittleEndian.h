#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

// Unsigned numbers as bytes, the lowest first.
namespace Rabit::LittleEndian
{

// Writes sizeof number bytes.
template <typename Number>
void Write(Number number, std::uint8_t *to)
{
    if constexpr (std::endian::native == std::endian::little)
    {
        std::memcpy(to, &number, sizeof number);
    }
    else
    {
        for (std::size_t i = 0; i < sizeof number; ++i)
        {
            to[i] = static_cast<std::uint8_t>(number >> 8 * i);
        }
    }
}

template <typename Number>
void Put(Number number, std::vector<std::uint8_t> &bytes)
{
    bytes.resize(bytes.size() + sizeof number);
    Write(number, bytes.data() + bytes.size() - sizeof number);
}

// Returns the number that consists of these bytes, of which there must not be more than it has; 0: none.
template <typename Number>
Number Read(std::span<const std::uint8_t> bytes)
{
    Number number = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        number = static_cast<Number>(number | static_cast<Number>(static_cast<Number>(bytes[i]) << 8 * i));
    }
    return number;
}

// Takes a number from the front; there must be enough bytes.
template <typename Number>
Number Take(std::span<const std::uint8_t> &bytes)
{
    const Number number = Read<Number>(bytes.first(sizeof(Number)));
    bytes = bytes.subspan(sizeof number);
    return number;
}

}  // namespace Rabit::LittleEndian
