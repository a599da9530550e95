#include "OneNode.h"

#include <algorithm>

#include "Offers.h"
#include "Output.h"

namespace Rabit::Tool
{

GatewayConfig ConfigWithoutOffers(const CommonOptions &options)
{
    GatewayConfig config = ConfigOf(options);
    config.Tool->AsksOf = {config.Node};
    return config;
}

const FleetSession::Node *FindNode(const std::vector<FleetSession::Node> &nodes, const std::string &node)
{
    const auto found = std::find_if(nodes.begin(), nodes.end(),
                                    [&node](const FleetSession::Node &one) { return one.Name == node; });
    return found == nodes.end() ? nullptr : &*found;
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
    const auto isThere = [&]
    {
        const auto nodes = session.Nodes();
        const FleetSession::Node *found = FindNode(nodes, node);
        return found != nullptr && found->State != Gateway::NodeState::LOST;
    };
    // Seconds in which a node that does not save on beats is heard.
    constexpr double everybody = 1.5;
    const auto isDecided = [&] {
        return isThere() ||
               (!options.IsWaitGiven && session.IsAnybodyThere() && session.Seconds() >= everybody);
    };
    if (!session.WaitUntil(std::min(everybody, options.Wait), isDecided))
    {
        session.WaitUntil(options.Wait, isDecided);
    }
    if (isThere())
    {
        return Good;
    }
    if (!session.IsAnybodyThere())
    {
        return session.NobodyThere();
    }
    Output::Talk(Offers::NoSuchNode(node, session.Nodes(), session.Seconds()));
    return ProblemFound;
}

}  // namespace Rabit::Tool
