#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <vector>

#include "doctor/Finding.h"
#include "doctor/MachineFacts.h"

// Problems of this machine, for a node with that configuration. Pure.
namespace Rabit::Tool::Doctor
{

// Returns the interfaces that such a node uses on any path: those named, or all that are up.
std::vector<Interface> UsedBy(const GatewayConfig &config, const std::vector<Interface> &interfaces);
// Returns the other ones that are up.
std::vector<Interface> UnusedBy(const GatewayConfig &config, const std::vector<Interface> &interfaces);

std::vector<Finding> OfInterfaces(const GatewayConfig &config, const std::vector<Interface> &interfaces);
// Finds interfaces whose MTU is too small for the configured datagrams.
std::vector<Finding> OfMtu(const GatewayConfig &config, const std::vector<Interface> &used);
// Finds datagrams lost at socket buffers between the two looks at the machine.
std::vector<Finding> OfBuffers(const GatewayConfig &config, const MachineFacts &before,
                               const MachineFacts &after);

}  // namespace Rabit::Tool::Doctor
