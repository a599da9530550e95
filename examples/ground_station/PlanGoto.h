#pragma once

#include "uav.idl.h"

#include <cstdint>

namespace Ground
{

// The Goto of the command with that id: 80 m from the aircraft's position, in another direction and at
// another height for each command, at 10 m/s. Sets everything but reply_to.
Uav::Goto PlanGoto(const Uav::Pose &pose, std::uint32_t id);

}  // namespace Ground
