// The names of targets: how they are written, and which of two holds.
#pragma once

#include "uav.idl.h"

#include <string>

namespace Common
{

// `uav1/3`.
std::string TextOf(const Uav::TargetName &name);
// Whether the first holds when one target has both.
bool IsOlder(const Uav::TargetName &first, const Uav::TargetName &second);
// Whether the target is or was called that.
bool IsCalled(const Uav::Target &target, const Uav::TargetName &name);
// What a message may bring: an aircraft, a number and a time, none of them absurd.
bool MakesSense(const Uav::TargetName &name);

}  // namespace Common
