#pragma once

#include <string>

namespace Rabit
{

// Says what the exception that is being handled is. To be called in a catch clause only.
std::string CurrentExceptionText();

}  // namespace Rabit
