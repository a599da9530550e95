// Checks commands from outside.
#pragma once

#include "uav.idl.h"

#include <string>

namespace Swarm
{

// The reason why the aircraft declines this; empty if it accepts it.
std::string WhyNot(const Uav::Goto &command);
std::string WhyNot(const Uav::SearchArea &area);
std::string WhyNot(const Uav::TargetReport &report);

}  // namespace Swarm
