#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <ctime>
#include <optional>
#include <string>

#include "gateway.idl.h"
#include "keys/Access.h"

namespace Rabit
{

// The topics and partitions that a gateway with this configuration writes and reads, no more and no less.
Keys::Access AccessOf(const GatewayConfig &config);

// Puts GatewayConfig::Security into the settings, once the keys are found good for this node over that
// transport now. Throws TransportError, of the setting `security`, with what to do. Returns when they end;
// nothing without security.
std::optional<std::time_t> AddSecurity(const GatewayConfig &config, const std::string &transport,
                                       TransportSettings &settings);

// That keys end within 30 days, or have ended.
std::optional<Gateway::Problem> KeysProblem(std::optional<std::time_t> endsAt, std::time_t now);

}  // namespace Rabit
