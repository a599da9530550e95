#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "recording/rerun/ManagerStep.h"

namespace Rabit::Rerun
{

// Returns a step as one line of JSON, as recordings hold it.
std::string TextOf(const ManagerStep &step);
// Reads a step; nothing if the text is none. No text makes it throw.
std::optional<ManagerStep> StepOf(std::string_view text);
// Returns the JSON schema of that line.
const char *StepSchema();

}  // namespace Rabit::Rerun
