#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "recording/rerun/ManagerStep.h"

namespace Rabit::Rerun
{

// A step as one line of JSON, which is what a recording holds of it.
std::string TextOf(const ManagerStep &step);
// Nothing if it is none. Never throws on account of the text.
std::optional<ManagerStep> StepOf(std::string_view text);
// What the JSON is, as a JSON schema.
const char *StepSchema();

}  // namespace Rabit::Rerun
