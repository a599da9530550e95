#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace TestNode
{

// Returns the octet at `place` of the padding of message `id`. Octets differ between messages and places,
// so that parts of two messages, or parts in a wrong order, show.
inline std::uint8_t PaddingAt(std::uint64_t id, std::size_t place)
{
    return static_cast<std::uint8_t>(id * 131 + place * 7 + (place >> 10));
}

inline std::vector<std::uint8_t> Padding(std::uint64_t id, std::size_t size)
{
    std::vector<std::uint8_t> padding(size);
    for (std::size_t i = 0; i < size; ++i)
    {
        padding[i] = PaddingAt(id, i);
    }
    return padding;
}

inline bool IsPadding(const std::vector<std::uint8_t> &padding, std::uint64_t id)
{
    for (std::size_t i = 0; i < padding.size(); ++i)
    {
        if (padding[i] != PaddingAt(id, i))
        {
            return false;
        }
    }
    return true;
}

}  // namespace TestNode
