#pragma once

#include <rabit/base/Fnv1a.h>

#include <cstdint>
#include <string_view>

namespace Rabit
{

// Returns a short name of one incarnation of a node, for frequent messages: a hash of the node name and the
// incarnation. Never 0. Two incarnations may share a tag, so a tag only addresses: a node that is addressed
// by mistake answers in vain.
inline std::uint32_t NodeTagOf(std::string_view node, std::uint64_t incarnation)
{
    const std::uint32_t tag = Fnv1a().Add(node).AddNumber(incarnation).Folded();
    return tag == 0 ? 1 : tag;
}

}  // namespace Rabit
