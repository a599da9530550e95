// Limits for untrusted texts. All are far above the needs of real messages. The worst text within them
// costs about a second and some megabytes. README.md lists them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace Rabit::Dynamic
{

inline constexpr std::size_t MaxTextSize = 128 * 1024;
inline constexpr std::size_t MaxTokens = 40000;
inline constexpr std::size_t MaxNameLength = 128;
inline constexpr std::size_t MaxStringLength = 4096;
// Nesting depth of brackets of any kind.
inline constexpr std::size_t MaxBrackets = 32;
// Nesting depth of types by members and elements.
inline constexpr unsigned MaxDepth = 64;
// Number of definitions; and of members, cases, enumerators and bits in total.
inline constexpr std::size_t MaxDefinitions = 1000;
inline constexpr std::size_t MaxParts = 2000;
// Bytes of a new value of any type in the text. Bounds products of array dimensions, also of structs in
// structs.
inline constexpr std::uint64_t MaxFreshSize = 8 * 1024 * 1024;
// Bytes of a sample made of JSON.
inline constexpr std::size_t MaxSampleSize = 64 * 1024 * 1024;

}  // namespace Rabit::Dynamic
