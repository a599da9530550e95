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

// Checks that the keys are valid now for this node over that transport, and puts GatewayConfig::Security into
// the settings. Throws TransportError, of the setting `security`, with what to do. Returns when the keys end;
// nothing without security.
std::optional<std::time_t> AddSecurity(const GatewayConfig &config, const std::string &transport,
                                       TransportSettings &settings);

// The problem that keys end within 30 days, or have ended.
std::optional<Gateway::Problem> KeysProblem(std::optional<std::time_t> endsAt, std::time_t now);

}  // namespace Rabit
