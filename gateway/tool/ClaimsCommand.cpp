// rabit claims: which node holds which claim.
#include <rabit/base/ListedNames.h>

#include <chrono>
#include <string>
#include <vector>

#include "Command.h"
#include "FleetClaims.h"
#include "FleetSession.h"
#include "NodeAnswers.h"
#include "OneNode.h"
#include "SafeText.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace ClaimsParts
{
namespace
{

struct Options
{
    CommonOptions Common;
};

double SecondsOf(std::chrono::milliseconds time)
{
    return std::chrono::duration<double>(time).count();
}

bool ShowJson(const FleetClaims &claims)
{
    bool good = true;
    for (const FleetClaims::Holding &holding : claims.Holdings)
    {
        good = good && Output::Object(Json{{"claim", holding.Claim},
                                           {"node", holding.Node},
                                           {"fence", std::to_string(holding.Fence)}});
    }
    for (const FleetClaims::List &list : claims.Lists)
    {
        good = good &&
               Output::Object(Json{
                   {"members", list.Members}, {"lease_s", SecondsOf(list.Lease)}, {"nodes", list.Nodes}});
    }
    for (const Gateway::Problem &problem : claims.Problems)
    {
        const Json node = problem.node.empty() ? Json(nullptr) : Json(problem.node);
        good = good &&
               Output::Object(Json{{"problem", problem.subject}, {"node", node}, {"reason", problem.reason}});
    }
    return good;
}

bool ShowTable(const FleetClaims &claims)
{
    std::vector<std::vector<std::string>> rows{{"CLAIM", "HOLDER", "FENCE"}};
    for (const FleetClaims::Holding &holding : claims.Holdings)
    {
        rows.push_back({SafeText(holding.Claim), SafeText(holding.Node), std::to_string(holding.Fence)});
    }
    bool good = rows.size() > 1 ? Output::Lines(TableLines(rows)) : Output::Line("no claim is held");
    for (const FleetClaims::List &list : claims.Lists)
    {
        good = good && Output::Line(SafeText("members " + NamesText(list.Members) + "; lease " +
                                             NumberText(SecondsOf(list.Lease), 1, " s") + "; " +
                                             std::to_string(list.Nodes.size()) + " of " +
                                             std::to_string(list.Members.size()) + " told their claims"));
    }
    for (const Gateway::Problem &problem : claims.Problems)
    {
        good = good && Output::Line(SafeText("! " + problem.subject + ": " + problem.reason));
    }
    return good;
}

int Run(const Options &options, Wakeup &wakeup)
{
    FleetSession session(ConfigWithoutOffers(options.Common), options.Common, wakeup);
    session.WaitForEverybody([] { return true; });
    if (!wakeup.IsInterrupted() && !session.IsAnybodyThere())
    {
        return session.NobodyThere();
    }
    const FleetClaims claims = FleetClaimsOf(
        AnswersOfAll(session, FleetExplorer::Report::Agreement,
                     session.Seconds() + (options.Common.IsWaitGiven ? options.Common.Wait : 3.0)));
    if (wakeup.IsInterrupted())
    {
        return Interrupted;
    }
    if (!claims.Silent.empty())
    {
        Output::Talk(
            "no word of claims from " + ListedNames(claims.Silent) +
            ": ask again, or give a longer --wait; a node with `reports: off` or of an older version "
            "tells none");
    }
    if (claims.Lists.empty() && claims.Problems.empty())
    {
        Output::Talk("no node that answered has an `agreement`");
        return ProblemFound;
    }
    const bool isRead = options.Common.Json ? ShowJson(claims) : ShowTable(claims);
    return claims.Problems.empty() || !isRead ? Good : ProblemFound;
}

}  // namespace
}  // namespace ClaimsParts

void AddClaimsCommand(CLI::App &app, Chosen &chosen)
{
    using namespace ClaimsParts;
    const auto [command, options] =
        AddCommand<Options>(app, chosen, "claims",
                            "Which node holds which claim, and whether the nodes agree on the members", &Run);
    AddCommonOptions(*command, options->Common, 1.8);
    AddExamples(*command, {"rabit claims", "rabit claims --json --wait 5"});
}

}  // namespace Rabit::Tool
