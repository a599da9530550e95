#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <chrono>
#include <cstdint>
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

}  // namespace Diagnosis
}  // namespace Rabit
