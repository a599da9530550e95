// What the configuration of an aircraft's nodes follows from their names.
#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>

namespace Swarm
{

// The aircraft that a vision node `uav1.vision` belongs to. Throws Rabit::ConfigError if it is no such name.
std::string AircraftOf(const std::string &visionNode);
// Says in the configuration of an aircraft what one file for a fleet cannot: of all Targets it takes those of
// its own vision node, and SearchArea from the ground station of that name. Throws Rabit::ConfigError.
void CompleteAircraftConfig(Rabit::GatewayConfig &config, const std::string &ground);

}  // namespace Swarm
