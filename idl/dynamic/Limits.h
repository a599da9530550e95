// What a text from a stranger may ask for. All are far above what messages of any use need, and low enough
// that the worst text costs about a second and some megabytes. README.md has them for people.
#pragma once

#include <cstddef>
#include <cstdint>

namespace Rabit::Dynamic
{

inline constexpr std::size_t MaxTextSize = 128 * 1024;
inline constexpr std::size_t MaxTokens = 40000;
inline constexpr std::size_t MaxNameLength = 128;
inline constexpr std::size_t MaxStringLength = 4096;
// Brackets of any kind within each other.
inline constexpr std::size_t MaxBrackets = 32;
// Types within types: members, elements.
inline constexpr unsigned MaxDepth = 64;
// Definitions, and members, cases, enumerators and bits of all together.
inline constexpr std::size_t MaxDefinitions = 1000;
inline constexpr std::size_t MaxParts = 2000;
// Bytes of a new value of any type in the text: bounds products of array dimensions, also of structs in
// structs.
inline constexpr std::uint64_t MaxFreshSize = 8 * 1024 * 1024;
// Bytes of a sample made of JSON.
inline constexpr std::size_t MaxSampleSize = 64 * 1024 * 1024;

}  // namespace Rabit::Dynamic
