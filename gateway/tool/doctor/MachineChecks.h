#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <vector>

#include "doctor/Finding.h"
#include "doctor/MachineFacts.h"

// What is wrong with this machine, for a node with that configuration. Pure.
namespace Rabit::Tool::Doctor
{

// The interfaces that such a node uses: those named, or all that are up.
std::vector<Interface> UsedBy(const GatewayConfig &config, const std::vector<Interface> &interfaces);

std::vector<Finding> OfInterfaces(const GatewayConfig &config, const std::vector<Interface> &interfaces);
// Whether its datagrams go in one piece.
std::vector<Finding> OfMtu(const GatewayConfig &config, const std::vector<Interface> &used);
// Before and after a while.
std::vector<Finding> OfBuffers(const GatewayConfig &config, const MachineFacts &before,
                               const MachineFacts &after);

}  // namespace Rabit::Tool::Doctor
