#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <string>
#include <vector>

namespace Rabit
{

// Checks the network settings of a configuration on this host, without joining the network. Throws
// ConfigError, with file and line of the setting, for what can never work, such as a peer that is no address
// or a backend_config that cannot be read. Returns a line for each thing that is only missing now, such as an
// interface that may yet come: a gateway starts without it and waits for it. May wait a second for the names
// of peers.
std::vector<std::string> CheckTransportSettings(const GatewayConfig &config, const Transport &transport);

}  // namespace Rabit
