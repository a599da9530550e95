// What comes from outside is checked before it is obeyed.
#pragma once

#include "uav.idl.h"

#include <string>

namespace Swarm
{

// Why the aircraft will not use this; empty if it will.
std::string WhyNot(const Uav::Goto &command);
std::string WhyNot(const Uav::SearchArea &area);
std::string WhyNot(const Uav::TargetReport &report);

}  // namespace Swarm
