// Makes the shapes of one message from an IDL text.
#pragma once

#include "dynamic/Shape.h"

#include <memory>
#include <string>
#include <string_view>

namespace Rabit::Dynamic
{

// If the text is refused, returns null and a reason in one line. May be called from any thread; calls wait
// for each other while they parse.
std::unique_ptr<const Shapes> ReadType(std::string_view idlText, const std::string &name,
                                       std::string &reason);

}  // namespace Rabit::Dynamic
