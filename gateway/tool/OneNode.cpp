#include "OneNode.h"

#include <algorithm>

#include "Output.h"

namespace Rabit::Tool
{

GatewayConfig ConfigWithoutOffers(const CommonOptions &options)
{
    GatewayConfig config = ConfigOf(options);
    config.Tool->AsksOf = {config.Node};
    return config;
}

std::optional<FleetExplorer::Answer> Request(FleetSession &session, const std::string &node,
                                             FleetExplorer::Report what, std::uint32_t argument)
{
    constexpr double longest = 10.0;
    FleetExplorer &explorer = session.Explorer();
    explorer.AskForReport(node, what, argument);
    std::optional<FleetExplorer::Answer> answer;
    session.WaitUntil(session.Seconds() + longest,
                      [&] { return (answer = explorer.TakeReport(node, what)).has_value(); });
    if (!answer)
    {
        Output::Talk(
            node +
            " does not answer; its gateway has `reports: off`, is of an older version, or does not hear "
            "this machine");
    }
    return answer;
}

int WaitForNode(FleetSession &session, const CommonOptions &options, const std::string &node)
{
    if (node.find_first_of("*?") != std::string::npos)
    {
        Output::Talk("`" + node + "`: wildcards are not taken here; name one node");
        return Usage;
    }
    const auto isThere = [&]
    {
        const auto nodes = session.Nodes();
        const FleetSession::Node *found = FindNode(nodes, node);
        return found != nullptr && found->State != Gateway::NodeState::LOST;
    };
    // The commands about one node request no announcements, so this waits for beats alone.
    const auto isDecided = [&]
    { return isThere() || (!options.IsWaitGiven && session.IsAnybodyThere() && session.IsEverybodyHeard()); };
    session.WaitUntilDecided(isDecided);
    if (isThere())
    {
        return Good;
    }
    if (!session.IsAnybodyThere())
    {
        return session.NobodyThere();
    }
    Output::Talk(session.NoSuchNode(node));
    return ProblemFound;
}

}  // namespace Rabit::Tool
