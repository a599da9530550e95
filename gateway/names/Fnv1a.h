#pragma once

#include <cstdint>

namespace Rabit
{

// The hash of Fowler, Noll and Vo (FNV-1a, 64 bits) of anything made of bytes: the same in every process and
// on every host. No protection against who looks for two that are equal.
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
