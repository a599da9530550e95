#include "FleetClaims.h"

#include <rabit/base/NaturalOrder.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>

#include "Table.h"
#include "wire/AgreementReport.h"

namespace Rabit::Tool
{
namespace
{

void AddProblem(const std::string &node, const std::string &reason, FleetClaims &claims)
{
    claims.Problems.push_back({"node " + node, node, reason});
}

void Add(const std::string &node, const AgreementReport::Contents &told, FleetClaims &claims)
{
    const auto same = std::find_if(claims.Lists.begin(), claims.Lists.end(),
                                   [&told](const FleetClaims::List &list)
                                   { return list.Members == told.Members && list.Lease == told.Lease; });
    FleetClaims::List &list = same != claims.Lists.end()
                                  ? *same
                                  : claims.Lists.emplace_back(FleetClaims::List{told.Members, told.Lease});
    list.Nodes.push_back(node);
    for (const AgreementReport::Held &held : told.Holdings)
    {
        claims.Holdings.push_back({held.Claim, node, held.Fence});
    }
}

// The members of all lists, and the problems of each that does not take part.
void LookAtMembers(const NodeAnswers &answers, const std::set<std::string> &without, FleetClaims &claims)
{
    std::set<std::string, NaturalOrder> members;
    for (const FleetClaims::List &list : claims.Lists)
    {
        members.insert(list.Members.begin(), list.Members.end());
    }
    for (const std::string &member : members)
    {
        const auto answer = answers.find(member);
        if (answer == answers.end())
        {
            AddProblem(member, "it is a member of the agreement and is not heard", claims);
        }
        else if (!answer->second)
        {
            AddProblem(member, "it is a member of the agreement and has not told its claims", claims);
        }
        else if (without.contains(member))
        {
            AddProblem(member, "it is a member of the agreement and has no `agreement` itself", claims);
        }
    }
}

// The lists that differ, and those without a majority.
void LookAtLists(FleetClaims &claims)
{
    for (const FleetClaims::List &list : claims.Lists)
    {
        const std::size_t majority = list.Members.size() / 2 + 1;
        const std::string nodes = NamesText(list.Nodes);
        if (claims.Lists.size() > 1)
        {
            claims.Problems.push_back(
                {"agreement of " + nodes, "",
                 "its members are " + NamesText(list.Members) + ", and its lease is " +
                     NumberText(std::chrono::duration<double>(list.Lease).count(), 1, " s") +
                     "; other nodes have another list, and claims of the two do not exclude each other"});
        }
        if (list.Nodes.size() < majority)
        {
            claims.Problems.push_back({"agreement of " + nodes, "",
                                       std::to_string(list.Nodes.size()) + " of " +
                                           std::to_string(list.Members.size()) +
                                           " members told that they have this list, and a majority is " +
                                           std::to_string(majority)});
        }
    }
}

}  // namespace

FleetClaims FleetClaimsOf(const NodeAnswers &answers)
{
    FleetClaims claims;
    std::set<std::string> without;  // nodes that have no agreement
    for (const auto &[node, answer] : answers)
    {
        if (!answer)
        {
            claims.Silent.push_back(node);
            continue;
        }
        const std::optional<AgreementReport::Contents> told = AgreementReport::ContentsOf(*answer);
        if (!told)
        {
            AddProblem(node, "its report on its claims makes no sense", claims);
        }
        else if (told->Members.empty())
        {
            without.insert(node);
        }
        else
        {
            Add(node, *told, claims);
        }
    }
    std::stable_sort(claims.Holdings.begin(), claims.Holdings.end(),
                     [](const FleetClaims::Holding &one, const FleetClaims::Holding &other) {
                         return one.Claim == other.Claim ? one.Fence > other.Fence
                                                         : NaturalOrder()(one.Claim, other.Claim);
                     });
    std::stable_sort(claims.Lists.begin(), claims.Lists.end(),
                     [](const FleetClaims::List &one, const FleetClaims::List &other)
                     { return one.Nodes.size() > other.Nodes.size(); });
    LookAtMembers(answers, without, claims);
    LookAtLists(claims);
    return claims;
}

}  // namespace Rabit::Tool
