// From an IDL text to the shapes of one message in it.
#pragma once

#include "dynamic/Shape.h"

#include <memory>
#include <string>
#include <string_view>

namespace Rabit::Dynamic
{

// Null and a reason, in one line, if the text is refused. May be called from any thread; one at a time
// parses.
std::unique_ptr<const Shapes> ReadType(std::string_view idlText, const std::string &name,
                                       std::string &reason);

}  // namespace Rabit::Dynamic
