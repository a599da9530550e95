#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>

namespace Swarm
{

// For CLI11: the problem if the text is not `dds` or `dds:/namespace`; empty if it is.
std::string IsPx4(const std::string &text);
// The namespace in it, for instance `/px4_1`; empty if there is none.
std::string Px4Namespace(const std::string &text);

// The foreign topics that Px4Vehicle needs, below that namespace, as PX4's agent calls them. An entry of
// the configuration for the same local message takes precedence: newer PX4 has topics like
// `vehicle_status_v1`.
void AddPx4Topics(Rabit::GatewayConfig &config, const std::string &prefix);

}  // namespace Swarm
