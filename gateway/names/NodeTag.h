#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "names/Fnv1a.h"

namespace Rabit
{

// A short name for one life of a node, for what is said often: a hash of its name and incarnation. Two lives
// may have one tag, so it only ever says who is meant, and whoever is meant by mistake answers in vain. Never
// 0.
inline std::uint32_t NodeTagOf(std::string_view node, std::uint64_t incarnation)
{
    std::string bytes(node);
    for (int shift = 0; shift < 64; shift += 8)
    {
        bytes += static_cast<char>(incarnation >> shift);
    }
    const std::uint64_t hash = Fnv1a(bytes);
    const auto tag = static_cast<std::uint32_t>(hash ^ (hash >> 32));
    return tag == 0 ? 1 : tag;
}

}  // namespace Rabit
