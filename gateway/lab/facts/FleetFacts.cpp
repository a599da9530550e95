#include "FleetFacts.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <iterator>

namespace Rabit::Facts
{
namespace
{

const char *WordOf(Gateway::NodeState state)
{
    switch (state)
    {
        case Gateway::NodeState::UP:
            return "UP";
        case Gateway::NodeState::STALE:
            return "STALE";
        default:
            return "LOST";
    }
}

}  // namespace

std::vector<FleetFacts::Json> FleetFacts::Look(std::span<const std::uint8_t> sample)
{
    Gateway::Fleet fleet;
    const MessageType *type = MessageTypeRegistry::Of(fleet);
    if (type == nullptr || !type->Deserialize(sample, fleet))
    {
        return {};
    }
    return Look(fleet);
}

std::vector<FleetFacts::Json> FleetFacts::Look(const Gateway::Fleet &fleet)
{
    std::vector<Json> facts;
    if (_incarnation != fleet.incarnation)
    {
        _incarnation = fleet.incarnation;
        facts.push_back({{"fact", "self"}, {"incarnation", std::to_string(fleet.incarnation)}});
    }
    for (const Gateway::NodeStatus &node : fleet.nodes)
    {
        const auto [known, isNew] = _peers.try_emplace(node.node, Peer{node.state, node.incarnation});
        Peer &peer = known->second;
        if (isNew || peer.State != node.state || peer.Incarnation != node.incarnation)
        {
            peer = {node.state, node.incarnation};
            facts.push_back({{"fact", "peer"},
                             {"of", node.node},
                             {"state", WordOf(node.state)},
                             {"reason", node.reason},
                             {"incarnation", std::to_string(node.incarnation)}});
        }
    }
    std::vector<Problem> problems;
    for (const Gateway::Problem &problem : fleet.problems)
    {
        problems.emplace_back(problem.subject, problem.node, problem.reason);
    }
    std::sort(problems.begin(), problems.end());
    const auto tell =
        [&facts](const char *fact, const std::vector<Problem> &now, const std::vector<Problem> &before)
    {
        std::vector<Problem> changed;
        std::set_difference(now.begin(), now.end(), before.begin(), before.end(),
                            std::back_inserter(changed));
        for (const auto &[subject, node, reason] : changed)
        {
            facts.push_back({{"fact", fact}, {"subject", subject}, {"node", node}, {"reason", reason}});
        }
    };
    tell("problem", problems, _problems);
    tell("solved", _problems, problems);
    _problems = std::move(problems);
    facts.push_back({{"fact", "air"},
                     {"used", fleet.air.used},
                     {"budget", fleet.air.budget},
                     {"capacity", fleet.air.capacity}});
    for (const Gateway::PublicationStatus &status : fleet.publications)
    {
        const std::pair<std::uint64_t, std::uint64_t> counts(status.offered, status.replaced);
        if (const auto [told, isNew] = _publications.try_emplace(status.message, counts);
            isNew || told->second != counts)
        {
            told->second = counts;
            facts.push_back({{"fact", "publication"},
                             {"message", status.message},
                             {"offered", status.offered},
                             {"replaced", status.replaced}});
        }
    }
    return facts;
}

}  // namespace Rabit::Facts
