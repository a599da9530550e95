#pragma once

#include "Limits.h"

#include <CLI/CLI.hpp>

namespace Common
{

// Checks that the value of an option is a number in that range. Unlike CLI::Range it refuses a NaN.
CLI::Validator NumberWithin(const Range &range);

}  // namespace Common
