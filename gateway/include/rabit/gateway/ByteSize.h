#pragma once

#include <cstdint>
#include <string>

namespace Rabit
{

// Sizes in bytes, as configuration files and options of the program `rabit` give them: `64MB`, `1GB`.

// The least and the most bytes that a setting takes, both included.
struct ByteRange
{
    std::uint64_t Least = 0;
    std::uint64_t Most = 0;
};

// The ranges of RecordSettings.
namespace RecordRanges
{

inline constexpr std::uint64_t Megabyte = 1'000'000;
inline constexpr std::uint64_t Terabyte = Megabyte * Megabyte;

inline constexpr ByteRange SplitSize{Megabyte, Terabyte};
inline constexpr ByteRange Keep{0, 1000 * Terabyte};
inline constexpr ByteRange Free{0, 1000 * Terabyte};
inline constexpr ByteRange Memory{Megabyte, 64000 * Megabyte};

}  // namespace RecordRanges

// Returns the bytes of a number with a unit: B, kB, MB, GB or TB, powers of 1000. A number without a unit is
// refused because its unit would be a guess; 0 needs none. Any other text, or a size outside of the range,
// throws std::invalid_argument with what is expected. Any thread may call it.
std::uint64_t ParseByteSize(const std::string &text, const ByteRange &range);

}  // namespace Rabit
