#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <vector>

#include "doctor/Finding.h"
#include "doctor/MachineFacts.h"
#include "doctor/NetworkFacts.h"

// What is wrong with the network, by what was tried. Pure.
namespace Rabit::Tool::Doctor
{

// Multicast on the interfaces used, out and in.
std::vector<Finding> OfMulticast(const GatewayConfig &config, const std::vector<Interface> &used,
                                 const NetworkFacts &facts);
// Other domains in use. `anyNode`: somebody was heard in ours.
std::vector<Finding> OfDomains(const GatewayConfig &config, const NetworkFacts &facts, bool anyNode);
// Who in our domain has keys and we have none, or the other way round.
std::vector<Finding> OfKeys(const GatewayConfig &config, const NetworkFacts &facts, bool anyNode);

}  // namespace Rabit::Tool::Doctor
