#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <string>

#include "keys/Access.h"

namespace Rabit
{

// The topics and partitions that a gateway with this configuration writes and reads, no more and no less.
Keys::Access AccessOf(const GatewayConfig &config);

// Puts GatewayConfig::Security into the settings, once the keys are found good for this node over that
// transport now. Throws TransportError, of the setting `security`, with what to do.
void AddSecurity(const GatewayConfig &config, const std::string &transport, TransportSettings &settings);

}  // namespace Rabit
