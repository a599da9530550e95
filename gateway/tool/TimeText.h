#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace Rabit::Tool
{

// Moments in texts for people. A moment is in nanoseconds since 1970 (UTC), as in recordings.

// Reads a moment: seconds from `begin`, as `12.5`, or UTC, as `2026-11-23T04:04:07.25Z` (or with a blank in
// place of the T, without fraction, without Z). Digits beyond nanoseconds are ignored. Nothing if the text is
// neither, if there is no such day, or if the moment does not fit.
std::optional<std::uint64_t> TimeOf(std::string_view text, std::uint64_t begin);

// Writes a duration in the unit that fits it: `0.35 ms`, `12.40 s`, `38.6 min`, `7.2 h`; `-` if it is not
// finite.
std::string DurationText(double seconds);

}  // namespace Rabit::Tool
