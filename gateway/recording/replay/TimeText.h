#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "recording/replay/ReplayItem.h"

namespace Rabit::Replay
{

// Reads a moment as a person writes it: seconds from `begin`, as 12.5, or UTC, as 2026-11-23T04:04:06.5.
// Nothing if the text is neither.
std::optional<Time> TimeOf(std::string_view text, Time begin);

// Writes a moment as TimeOf reads it, to the millisecond.
std::string TextOf(Time time);

}  // namespace Rabit::Replay
