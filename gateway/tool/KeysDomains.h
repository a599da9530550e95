#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <map>
#include <string>

#include "keys/FleetKeys.h"

namespace Rabit::Tool
{

// For the commands of `rabit keys`: configurations of nodes, and the domains that keys are for.

// Reads a configuration, of which any type name will do: types do not matter to keys. Throws ConfigError.
GatewayConfig ConfigForKeys(const std::string &file, const std::string &node);

// The domain that the keys are for; -1: none, or several.
int DomainOf(const Keys::NodeKeys &keys);

// How many nodes of the fleet have keys for which domain.
std::map<int, std::size_t> DomainsOf(const Keys::FleetKeys &fleet);

}  // namespace Rabit::Tool
