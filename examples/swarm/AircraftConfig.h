// Completes the configuration of an aircraft's nodes from their names.
#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>

namespace Swarm
{

// The aircraft that a vision node `uav1.vision` belongs to. Throws Rabit::ConfigError if it is no such name.
std::string AircraftOf(const std::string &visionNode);
// Completes the configuration of an aircraft, as one file serves a whole fleet: Targets come only from its
// own vision node, and SearchArea and Geofence from the ground station of that name. Throws
// Rabit::ConfigError.
void CompleteAircraftConfig(Rabit::GatewayConfig &config, const std::string &ground);

}  // namespace Swarm
