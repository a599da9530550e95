// rabit nodes: the nodes of the fleet.
#include <algorithm>
#include <cmath>

#include "Command.h"
#include "FleetSession.h"
#include "ForeignTopics.h"
#include "NodeProblems.h"
#include "Offers.h"
#include "RosNodes.h"
#include "SafeText.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace NodesParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    bool Watch = false;
    bool Foreign = false;
};

template <typename Items, typename NameOf>
std::string Names(const Items &items, NameOf nameOf)
{
    std::string text;
    for (const auto &item : items)
    {
        text += (text.empty() ? "" : " ") + SafeText(nameOf(item));
    }
    return text.empty() ? "-" : text;
}

// Returns all problems, in lines.
std::vector<Gateway::Problem> ProblemsOf(const Gateway::Fleet &fleet,
                                         const std::vector<FleetSession::Node> &nodes)
{
    std::vector<Gateway::Problem> problems(fleet.problems.begin(), fleet.problems.end());
    for (const Gateway::NodeStatus &node : fleet.nodes)
    {
        if (node.state != Gateway::NodeState::UP && node.reason != "left")
        {
            problems.push_back({"node " + node.node, node.node, node.reason});
        }
    }
    const std::vector<Gateway::Problem> own = ProblemsOfNodes(fleet);
    problems.insert(problems.end(), own.begin(), own.end());
    const auto add = [&problems](const std::string &node, const std::string &reason)
    {
        Gateway::Problem &problem = problems.emplace_back();
        problem.subject = "node " + node;
        problem.node = node;
        problem.reason = reason;
    };
    for (const FleetSession::Node &node : nodes)
    {
        if (!node.Offers && node.State != Gateway::NodeState::LOST)
        {
            add(node.Name, "its announcement has not come; ask again in 2 s");
        }
        if (!node.AreProblemsKnown && node.State != Gateway::NodeState::LOST)
        {
            add(node.Name, "its own problems are not known yet; ask again in 2 s");
        }
    }
    for (const std::string &line : Offers::Differences(nodes))
    {
        problems.push_back({"types", "", line});
    }
    return problems;
}

Json JsonOf(const Gateway::NodeStatus &status, const FleetSession::Node *node)
{
    Json object;
    object["node"] = status.node;
    object["state"] = ToString(status.state);
    object["reason"] = status.reason;
    object["incarnation"] = std::to_string(status.incarnation);
    object["last_heard_s"] = status.last_heard_s;
    object["round_trip_s"] = status.round_trip_s;
    object["delivery_rate"] = status.delivery_rate > 0.0 ? Json(status.delivery_rate) : Json(nullptr);
    for (const Gateway::PathToNode &path : status.paths)
    {
        object["path"] = status.path;
        object["paths"].push_back({{"path", path.path},
                                   {"state", ToString(path.state)},
                                   {"last_heard_s", path.last_heard_s},
                                   {"round_trip_s", path.round_trip_s}});
    }
    object["publishes"] = Json::array();
    object["accepts"] = Json::array();
    if (node != nullptr && node->Offers)
    {
        for (const auto &published : node->Offers->publishes)
        {
            object["publishes"].push_back({{"message", published.message},
                                           {"type", published.type},
                                           {"qos", published.qos},
                                           {"definition", Offers::HashText(published.definition)}});
        }
        for (const auto &accepted : node->Offers->accepts)
        {
            Json types = Json::array();
            for (const auto &type : accepted.types)
            {
                types.push_back({{"type", type.type}, {"definition", Offers::HashText(type.definition)}});
            }
            object["accepts"].push_back(
                {{"queue", accepted.queue}, {"types", types}, {"from", accepted.from}});
        }
    }
    object["replay"] = status.replay;
    return object;
}

bool ShowJson(const Gateway::Fleet &fleet, const std::vector<FleetSession::Node> &nodes,
              const std::vector<Gateway::Problem> &problems)
{
    bool good = true;
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        good = good && Output::Object(JsonOf(status, FindNode(nodes, status.node)));
    }
    for (const Gateway::Problem &problem : problems)
    {
        const Json node = problem.node.empty() ? Json(nullptr) : Json(problem.node);
        good = good &&
               Output::Object(Json{{"problem", problem.subject}, {"node", node}, {"reason", problem.reason}});
    }
    return good;
}

// The path in use, and the state on the others: `mesh (modem STALE)`.
std::string PathText(const Gateway::NodeStatus &status)
{
    std::string others;
    for (const Gateway::PathToNode &path : status.paths)
    {
        if (path.path != status.path)
        {
            others += (others.empty() ? "" : ", ") + SafeText(path.path) + ' ' + ToString(path.state);
        }
    }
    return SafeText(status.path) + (others.empty() ? "" : " (" + others + ")");
}

bool ShowTable(const Gateway::Fleet &fleet, const std::vector<FleetSession::Node> &nodes,
               const std::vector<Gateway::Problem> &problems)
{
    std::vector<std::vector<std::string>> rows{
        {"NODE", "STATE", "HEARD", "ROUND TRIP", "DELIVERY", "PUBLISHES", "ACCEPTS"}};
    // This program may itself reach the fleet over several paths (--config).
    const bool hasPaths = !fleet.paths.empty();
    if (hasPaths)
    {
        rows.front().push_back("PATH");
    }
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        const FleetSession::Node *node = FindNode(nodes, status.node);
        const bool known = node != nullptr && node->Offers;
        rows.push_back(
            {SafeText(status.node), std::string(ToString(status.state)) + (status.replay ? " (replay)" : ""),
             NumberText(status.last_heard_s, 1, " s"), NumberText(1000.0 * status.round_trip_s, 1, " ms"),
             status.delivery_rate > 0.0 ? NumberText(status.delivery_rate, 0, " B/s") : "-",
             known ? Names(node->Offers->publishes, [](const auto &item) { return item.message; }) : "?",
             known ? Names(node->Offers->accepts, [](const auto &item) { return item.queue; }) : "?"});
        if (hasPaths)
        {
            rows.back().push_back(PathText(status));
        }
    }
    bool good = Output::Lines(TableLines(rows));
    for (const Gateway::Problem &problem : Joined(problems))
    {
        good = good && Output::Line(SafeText("! " + problem.subject + ": " + problem.reason));
    }
    return good;
}

// True if the first answer would be complete.
bool IsWhole(FleetSession &session)
{
    const Gateway::Fleet fleet = session.Fleet();
    return !fleet.nodes.empty() && Offers::AreComplete(session.Nodes()) &&
           AreProblemsKnown(session.Nodes()) &&
           std::all_of(fleet.nodes.begin(), fleet.nodes.end(),
                       [](const Gateway::NodeStatus &node) {
                           return node.state == Gateway::NodeState::LOST || std::isfinite(node.round_trip_s);
                       });
}

// Seconds in which participants of ROS 2 are found that are there, and tell the names of their nodes.
constexpr double RosAnswers = 2.0;

bool ShowForeign(FleetSession &session, const Options &options, const RosNodes &ros)
{
    if (!options.Foreign)
    {
        return true;
    }
    session.WaitUntil(std::min(RosAnswers, options.Common.Wait));
    return ShowForeignTopics(session, options.Common) &&
           ShowRosNodes(ros.Of(session.Fleet()), options.Common.Json);
}

int Show(FleetSession &session, const Options &options, const RosNodes &ros, bool &stillRead)
{
    const Gateway::Fleet fleet = session.Fleet();
    const std::vector<FleetSession::Node> nodes = session.Nodes();
    const std::vector<Gateway::Problem> problems = ProblemsOf(fleet, nodes);
    stillRead = options.Common.Json ? ShowJson(fleet, nodes, problems) : ShowTable(fleet, nodes, problems);
    stillRead = stillRead && ShowForeign(session, options, ros);
    return problems.empty() ? Good : ProblemFound;
}

int Run(const Options &options, Wakeup &wakeup)
{
    GatewayConfig config = ConfigOf(options.Common);
    config.ProblemsOf = {"*"};
    RosNodes ros;
    if (options.Foreign)
    {
        RosNodes::AddTo(config);
    }
    FleetSession session(config, options.Common, wakeup,
                         [&ros](FleetSession &joining) { ros.Attach(joining.Workspace()); });
    session.WaitForEverybody([&session] { return IsWhole(session); });
    if (wakeup.IsInterrupted() && !options.Watch)
    {
        return Interrupted;
    }
    if (!session.IsAnybodyThere() && !options.Watch)
    {
        ShowForeign(session, options, ros);
        return session.NobodyThere();
    }
    bool stillRead = true;
    int code = Good;
    for (double second = session.Seconds();; second += 1.0)
    {
        if (options.Watch && !options.Common.Json)
        {
            Output::BeginScreen();
        }
        code = Show(session, options, ros, stillRead);
        if (!options.Watch || !stillRead || wakeup.IsInterrupted())
        {
            return stillRead ? code : Good;
        }
        session.WaitUntil(second + 1.0);
    }
}

}  // namespace
}  // namespace NodesParts

void AddNodesCommand(CLI::App &app, Chosen &chosen)
{
    using namespace NodesParts;
    const auto [command, options] =
        AddCommand<Options>(app, chosen, "nodes", "Who is there, what each has, and what is wrong", &Run);
    AddCommonOptions(*command, options->Common, 1.8);
    command->add_flag("--watch", options->Watch, "Show it again each second until Ctrl-C");
    command->add_flag(
        "--foreign", options->Foreign,
        "Also the topics of programs without a gateway, as of ROS 2, that nodes read or write, and the "
        "names of ROS 2 nodes");
    AddExamples(*command, {"rabit nodes --domain 7", "rabit nodes --watch", "rabit nodes --json --wait 5"});
}

}  // namespace Rabit::Tool
