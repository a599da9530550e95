#pragma once

#include <string>

namespace Rabit
{

// Describes the exception that is being handled. Call it only in a catch clause.
std::string CurrentExceptionText();

}  // namespace Rabit
