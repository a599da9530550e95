#pragma once

#include <optional>
#include <string>

#include "recording/merge/Moment.h"

namespace Rabit::Merge
{

// Reads a moment as people write it: seconds since the beginning, as `12.5`, or UTC, as
// `2026-11-23T04:04:07.25Z` (or with a blank, without fraction, without Z). Empty if it is neither.
std::optional<Moment> ParseMoment(const std::string &text, Moment beginning);

// `2026-11-23 04:04:07.250 UTC`
std::string DateOf(Moment moment);

}  // namespace Rabit::Merge
