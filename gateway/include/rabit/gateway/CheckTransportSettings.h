#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <string>
#include <vector>

namespace Rabit
{

// Checks the network settings of a configuration on this host, without joining the network. Throws
// ConfigError, with file and line of the setting, for a setting that can never work. Examples are a peer that
// is no address, and a backend_config that cannot be read. Returns a line for each thing that is missing only
// now, such as an interface that may yet come: a gateway starts without it and waits for it. Resolving the
// names of peers may take a second.
std::vector<std::string> CheckTransportSettings(const GatewayConfig &config, const Transport &transport);

}  // namespace Rabit
