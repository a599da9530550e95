#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit::Test
{

// The bytes as hexadecimal digits, 32 bytes to a line, as the tests quote them.
inline std::string HexOf(std::span<const std::uint8_t> bytes)
{
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        text += i > 0 && i % 32 == 0 ? "\n" : "";
        text += digits[bytes[i] >> 4];
        text += digits[bytes[i] & 0xf];
    }
    return text;
}

// The inverse of HexOf.
inline std::vector<std::uint8_t> BytesOf(std::string_view hex)
{
    const auto valueOf = [](char digit) -> unsigned
    {
        if (digit >= '0' && digit <= '9')
        {
            return static_cast<unsigned>(digit - '0');
        }
        if (digit >= 'a' && digit <= 'f')
        {
            return static_cast<unsigned>(digit - 'a') + 10;
        }
        throw std::invalid_argument("not a hexadecimal digit");
    };
    std::vector<std::uint8_t> bytes;
    bool isLow = false;
    for (const char digit : hex)
    {
        if (digit == '\n')
        {
            continue;
        }
        if (isLow)
        {
            bytes.back() = static_cast<std::uint8_t>(bytes.back() | valueOf(digit));
        }
        else
        {
            bytes.push_back(static_cast<std::uint8_t>(valueOf(digit) << 4));
        }
        isLow = !isLow;
    }
    return bytes;
}

}  // namespace Rabit::Test
