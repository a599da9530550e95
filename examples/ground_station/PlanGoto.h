#pragma once

#include "uav.idl.h"

#include <cstdint>

namespace Ground
{

// The point that the command of that number sends an aircraft to: 80 m from where it is, in another direction
// and at another height for each command, at 10 m/s. Sets everything but reply_to.
Uav::Goto PlanGoto(const Uav::Pose &pose, std::uint32_t id);

}  // namespace Ground
