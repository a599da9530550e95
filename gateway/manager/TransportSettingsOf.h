#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <cstdint>
#include <string>

namespace Rabit
{

// The transport settings of a gateway with that configuration.
TransportSettings TransportSettingsOf(const GatewayConfig &config, std::uint64_t incarnation);

// The line in the configuration's file at which a setting of the transport stands, 0 if it does not stand
// there.
int LineOfSetting(const GatewayConfig &config, const std::string &setting);

}  // namespace Rabit
