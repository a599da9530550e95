#pragma once

#include <rabit/gateway/Fleet.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "NodeAnswers.h"

namespace Rabit::Tool
{

// The claims of a fleet, as its nodes told them, each at its own moment. So a claim that changed hands
// meanwhile may be there twice: the higher fence is the later one.
struct FleetClaims
{
    struct Holding
    {
        std::string Claim;
        std::string Node;
        std::uint64_t Fence = 0;
    };
    // The members and the lease of an agreement, and the nodes that have them.
    struct List
    {
        std::vector<std::string> Members;
        std::chrono::milliseconds Lease{0};
        std::vector<std::string> Nodes{};
    };

    std::vector<Holding> Holdings{};  // by claim, the highest fence first
    std::vector<List> Lists{};        // without a problem at most one; first the one that most nodes have
    std::vector<Gateway::Problem> Problems{};
    std::vector<std::string> Silent{};  // nodes that have not answered
};

// `answers`: to FleetExplorer::Report::Agreement, of all live nodes.
FleetClaims FleetClaimsOf(const NodeAnswers &answers);

}  // namespace Rabit::Tool
