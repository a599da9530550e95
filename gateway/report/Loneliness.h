#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <functional>
#include <optional>

#include "gateway.idl.h"
#include "paths/PeersOverPaths.h"

namespace Rabit
{

// Reports that a node hears no other node. It cannot hear nodes of other domains, or nodes whose multicast
// does not get through, so the report tells where this node listens and what it sends. A node with foreign
// topics that wants nothing of other nodes is not lonely while it hears foreign programs.
namespace Loneliness
{

// No other node is live for this long. The text of the problem names this time, not the time so far: a
// growing number would make a new problem each second.
inline constexpr std::chrono::nanoseconds Patience = std::chrono::seconds(10);

// True if a program that is no node has a writer or reader that the session knows.
bool HearsPrograms(const TransportSession &session);

// Returns the problem, if there is one. `openedAt` is when this node began to listen. `hearsPrograms` is
// called only if no node is live.
std::optional<Gateway::Problem> Look(const GatewayConfig &config, const PeersOverPaths &peers,
                                     const TransportCounters &counters,
                                     const std::function<bool()> &hearsPrograms,
                                     std::chrono::nanoseconds openedAt, std::chrono::nanoseconds now);

}  // namespace Loneliness
}  // namespace Rabit
