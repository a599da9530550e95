#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <optional>

#include "gateway.idl.h"
#include "presence/PeerTable.h"

namespace Rabit
{

// What a node can know while it hears nobody. Nodes of other domains, and those whose multicast does not
// come through, are not heard at all: so it says where it listens, and what goes out. Pure functions of their
// arguments.
namespace Loneliness
{

// Nobody is live for so long. The problem says that, and not for how long by now: who lists problems as they
// come would list a new one each second.
inline constexpr std::chrono::nanoseconds Patience = std::chrono::seconds(10);

// The problem, if there is one. `openedAt`: since when this node listens.
std::optional<Gateway::Problem> Look(const GatewayConfig &config, const PeerTable &peers,
                                     const TransportCounters &counters, std::chrono::nanoseconds openedAt,
                                     std::chrono::nanoseconds now);

}  // namespace Loneliness
}  // namespace Rabit
