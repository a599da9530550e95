#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "names/Fnv1a.h"

namespace Rabit
{

// Returns a short name of one incarnation of a node, for frequent messages: a hash of the node name and the
// incarnation. Never 0. Two incarnations may share a tag, so a tag only addresses: a node that is addressed
// by mistake answers in vain.
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
