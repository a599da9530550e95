#pragma once

#include "Limits.h"

#include <CLI/CLI.hpp>

namespace Common
{

// The check of an option whose value is to be a number in that range. Unlike CLI::Range it refuses a NaN.
CLI::Validator NumberWithin(const Range &range);

}  // namespace Common
