#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "PeerTable.h"
#include "gateway.idl.h"

namespace Rabit
{

// Tells, by name, why an expected message does not come: compares what this node wants with what the others
// announce. Pure functions of their arguments.
namespace Diagnosis
{

// How one subscription does with one node.
struct Reception
{
    std::uint64_t Received = 0;  // samples posted
    int MatchedWriters = 0;      // DDS writers that match the subscription, of all nodes together
    std::string LocalProblem;    // why samples cannot be posted here; empty if they can
};

struct Wanted
{
    const SubscribeRule *Rule = nullptr;
    std::uint64_t Definition = 0;  // hash of the type's IDL here
    std::function<Reception(const std::string &node)> ReceptionFrom;
};

// A node's data are given this long before their absence is called a problem.
inline constexpr std::chrono::nanoseconds Patience = std::chrono::milliseconds(1500);

// Problems of one subscription, at most one for each node that it covers; one without a node if there is no
// such node.
std::vector<Gateway::Problem> OfSubscription(const Wanted &wanted, const PeerTable &peers,
                                             std::chrono::nanoseconds sinceStart,
                                             std::chrono::nanoseconds now);

// Whether a node takes messages of a type for a queue.
struct Acceptance
{
    bool QueueKnown = false;
    std::string Reason;  // why not, for people; empty if it does
};
Acceptance OfQueue(const PeerTable::Peer &peer, const std::string &queue, const std::string &type,
                   std::uint64_t definition);

}  // namespace Diagnosis
}  // namespace Rabit
