#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "gateway.idl.h"
#include "mirrors/Reception.h"
#include "paths/PeersOverPaths.h"

namespace Rabit
{

class Subscriptions;

// Tells, by name, why an expected message does not come. Compares the subscriptions of this node with the
// announcements of the others. Pure functions of their arguments.
namespace Diagnosis
{

struct Wanted
{
    const SubscribeRule *Rule = nullptr;
    std::uint64_t Definition = 0;  // hash of the type's IDL here
    std::function<Reception(const std::string &node)> ReceptionFrom;
};

// Data of a node may be missing for this long before that is a problem.
inline constexpr std::chrono::nanoseconds Patience = std::chrono::milliseconds(1500);

// Returns the problems of one subscription: at most one for each node that it covers, or one without a node
// if no such node was heard.
std::vector<Gateway::Problem> OfSubscription(const Wanted &wanted, const PeersOverPaths &peers,
                                             std::chrono::nanoseconds sinceStart,
                                             std::chrono::nanoseconds now);

// Returns the problems of all subscriptions.
std::vector<Gateway::Problem> OfSubscriptions(const Subscriptions &subscriptions, const PeersOverPaths &peers,
                                              std::chrono::nanoseconds sinceStart,
                                              std::chrono::nanoseconds now);

// Returns the problem of each node that was heard, is LOST, and that this node wants: one that `subscribe`
// covers, that `send` names, or for which messages wait (`outbox` of its row in `fleet`). A node that said
// goodbye is wanted only by its name or for messages that wait, not by a pattern.
std::vector<Gateway::Problem> OfLostNodes(const std::deque<SubscribeRule> &subscribe,
                                          const std::vector<SendRule> &send, const Gateway::Fleet &fleet,
                                          const PeersOverPaths &peers);

}  // namespace Diagnosis
}  // namespace Rabit
