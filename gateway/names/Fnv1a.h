#pragma once

#include <cstdint>

namespace Rabit
{

// Returns the FNV-1a hash (Fowler, Noll and Vo, 64 bits) of a range of bytes: the same in every process and
// on every host. An attacker can easily find two inputs with one hash.
template <typename Bytes>
constexpr std::uint64_t Fnv1a(const Bytes &bytes)
{
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const auto item : bytes)
    {
        static_assert(sizeof item == 1);
        hash = (hash ^ static_cast<std::uint8_t>(item)) * 0x100000001b3;
    }
    return hash;
}

}  // namespace Rabit
