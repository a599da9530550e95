// Makes the shapes of one message from an IDL text.
#pragma once

#include <rabit/dynamic/Shape.h>

#include "model/Model.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace Rabit::Dynamic
{

// If the text is refused, returns null and a reason in one line. May be called from any thread; calls wait
// for each other while they parse.
std::unique_ptr<const Shapes> ReadType(std::string_view idlText, const std::string &name,
                                       std::string &reason);

// Passes the model of a text to a function, which may throw Refused. Returns why there is none, in one line;
// empty if it was called. The text is parsed unchecked if it `isTrusted`. Threads as above.
std::string ReadModel(std::string_view idlText, bool isTrusted,
                      const std::function<void(const RabitIdl::Model &)> &use);

}  // namespace Rabit::Dynamic
