// Checks on frames from the wire, made before anything changes. They use the frame alone.
#pragma once

#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkOptions.h>

namespace Rabit
{

// 1 to LinkMaxName bytes.
bool IsPossibleName(std::string_view name);
// True if it is not 0 and a higher one exists.
bool IsPossibleIncarnation(std::uint64_t incarnation);

bool IsWellFormed(const LinkFrame &frame);

// Throw std::invalid_argument, naming the field, if a value is out of its range.
void RequireValid(const LinkSettings &settings);
void RequireValid(const LinkOptions &options);

}  // namespace Rabit
