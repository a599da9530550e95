// The names of targets: as text, and in order of precedence.
#pragma once

#include "uav.idl.h"

#include <string>

namespace Common
{

// `uav1/3`.
std::string TextOf(const Uav::TargetName &name);
// True if the first name holds when one target has both.
bool IsOlder(const Uav::TargetName &first, const Uav::TargetName &second);
// True if the target has or had that name.
bool IsCalled(const Uav::Target &target, const Uav::TargetName &name);
// True if a name from a message is plausible: it has an aircraft, a number and a time.
bool MakesSense(const Uav::TargetName &name);

}  // namespace Common
