#include "doctor/NodeChecks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <string_view>

#include "NodeProblems.h"
#include "Offers.h"

namespace Rabit::Tool::Doctor
{
namespace
{

// Seconds. A larger difference confuses logs and recordings, and half of a usual round trip does not explain
// it.
constexpr double ClockTolerance = 1.0;
// The loss of fewer beats than this may be chance.
constexpr std::uint64_t FewBeats = 10;
constexpr double MuchLost = 0.1;
// Full queues of a node that a line names.
constexpr std::size_t MostNamed = 3;

std::string Text(const char *format, double number)
{
    char text[64];
    std::snprintf(text, sizeof text, format, number);
    return text;
}

std::string Seconds(double seconds)
{
    return Text("%.1f s", std::abs(seconds));
}

double RoundTripOf(const std::string &node, const Gateway::Fleet &fleet)
{
    const auto found =
        std::find_if(fleet.nodes.begin(), fleet.nodes.end(),
                     [&node](const Gateway::NodeStatus &status) { return status.node == node; });
    return found == fleet.nodes.end() || !std::isfinite(found->round_trip_s) ? 0.0 : found->round_trip_s;
}

std::string Many(unsigned messages)
{
    // The largest number in a beat.
    constexpr unsigned most = 65535;
    return std::to_string(messages) + (messages >= most ? " or more" : "");
}

struct FullQueue
{
    std::string Name;
    std::uint64_t Messages = 0;  // that wait in it
};

// Returns the full queues of a node for which messages of `other` wait, the longest first. Beats do not name
// queues. The node's problems do: `queue NAME: it is full (N messages), ... those of `OTHER` wait`.
std::vector<FullQueue> FullQueuesOf(const std::string &node, const std::string &other,
                                    const Gateway::Fleet &fleet)
{
    constexpr std::string_view before = "queue ";
    constexpr std::string_view after = ": it is full (";
    std::vector<FullQueue> queues;
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        if (status.node != node)
        {
            continue;
        }
        for (const std::string &text : status.problem_texts)
        {
            const std::size_t name = text.find(after);
            if (!text.starts_with(before) || name == std::string::npos ||
                text.find("`" + other + "`", name) == std::string::npos)
            {
                continue;
            }
            FullQueue &queue = queues.emplace_back();
            queue.Name = text.substr(before.size(), name - before.size());
            const char *const number = text.data() + name + after.size();
            std::from_chars(number, text.data() + text.size(), queue.Messages);
        }
    }
    std::stable_sort(queues.begin(), queues.end(),
                     [](const FullQueue &one, const FullQueue &two) { return one.Messages > two.Messages; });
    return queues;
}

Finding OfHeldBack(const std::string &node, const std::string &other, const std::vector<FullQueue> &queues)
{
    std::string names;
    for (std::size_t i = 0; i < queues.size() && i < MostNamed; ++i)
    {
        names += (i > 0 ? ", `" : "`") + queues[i].Name + "`";
    }
    if (queues.size() > MostNamed)
    {
        names += " and " + std::to_string(queues.size() - MostNamed) + " more";
    }
    const bool isOne = queues.size() <= 1;
    return {Level::Problem, (isOne ? "queue of " : "queues of ") + node,
            (names.empty() ? "it" : names) + (isOne ? " is" : " are") + " full, and messages of " + other +
                " wait",
            isOne ? "look what keeps its manager from taking them, or give the queue more capacity"
                  : "look what keeps their managers from taking them, or give the queues more capacity"};
}

Finding OfStrain(const std::string &node, const FleetExplorer::Strain &strain, const Gateway::Fleet &fleet)
{
    using Kind = FleetExplorer::Strain::Kind;
    const std::string other = strain.Other.empty() ? "a node that is not heard here" : strain.Other;
    switch (strain.What)
    {
        case Kind::Filling:
            return {strain.Messages > 0 ? Level::Problem : Level::Note, "outbox of " + node,
                    "that for " + other + " is " + std::to_string(strain.Percent) + " % full" +
                        (strain.Messages > 0 ? ", and of late it refused " + Many(strain.Messages) : ""),
                    "look whether " + other + " is up and its queues have room; else send less"};
        case Kind::InDoubt:
            return {Level::Problem, "messages of " + node,
                    Many(strain.Messages) + " to " + other + " in doubt: it restarted before it acknowledged",
                    "send again what still matters, and look why it restarted"};
        case Kind::HeldBack:
            break;
    }
    return OfHeldBack(node, other, FullQueuesOf(node, strain.Other, fleet));
}

}  // namespace

std::vector<Finding> OfNodes(const std::vector<FleetSession::Node> &nodes, const Gateway::Fleet &fleet)
{
    std::vector<Finding> findings;
    std::string up;
    for (const FleetSession::Node &node : nodes)
    {
        if (node.State == Gateway::NodeState::LOST)
        {
            continue;
        }
        up += (up.empty() ? "" : " ") + node.Name;
        if (node.IsTwice)
        {
            findings.push_back(
                {Level::Problem, "node " + node.Name, "two live nodes have this name",
                 "give one of them another one (`node:`); both say in their log where they run"});
        }
        if (!node.Offers)
        {
            findings.push_back({Level::Problem, "node " + node.Name,
                                "it beats, and its announcement does not come",
                                "wait longer (--wait), or look whether what this machine sends gets there"});
        }
        else if (!node.AreProblemsKnown)
        {
            findings.push_back({Level::Note, "node " + node.Name, "its own problems are not known yet",
                                "wait longer (--wait)"});
        }
    }
    std::vector<Gateway::Problem> problems(fleet.problems.begin(), fleet.problems.end());
    const std::vector<Gateway::Problem> ofNodes = ProblemsOfNodes(fleet);
    problems.insert(problems.end(), ofNodes.begin(), ofNodes.end());
    for (const Gateway::Problem &problem : Joined(problems))
    {
        findings.push_back({Level::Problem, problem.subject, problem.reason, "docs/what_rabit_tells_you.md"});
    }
    if (!up.empty())
    {
        findings.push_back({Level::Good, "nodes", up});
    }
    if (fleet.malformed > 0)
    {
        findings.push_back({Level::Problem, "gateways",
                            std::to_string(fleet.malformed) + " samples made no sense",
                            "look for programs of another version, or for somebody who means harm"});
    }
    return findings;
}

std::vector<Finding> OfPaths(const Gateway::Fleet &fleet, double listened)
{
    std::map<std::string, std::string> heard;  // nodes by path
    for (const Gateway::NodeStatus &node : fleet.nodes)
    {
        for (const Gateway::PathToNode &path : node.paths)
        {
            heard[path.path] += path.state == Gateway::NodeState::LOST ? "" : " " + node.node;
        }
    }
    const bool any =
        std::any_of(heard.begin(), heard.end(), [](const auto &path) { return !path.second.empty(); });
    std::vector<Finding> findings;
    for (const Gateway::PathStatus &path : fleet.paths)
    {
        const std::string subject = "path " + path.path;
        const bool isKnown =
            std::any_of(fleet.problems.begin(), fleet.problems.end(),
                        [&subject](const Gateway::Problem &problem) { return problem.subject == subject; });
        if (!heard[path.path].empty())
        {
            findings.push_back({Level::Good, subject, "heard:" + heard[path.path]});
        }
        else if (any && !isKnown)
        {
            findings.push_back(
                {Level::Problem, subject,
                 "nobody was heard on it for " + Seconds(listened) + ", and others by other paths",
                 "look at its radio, its `interfaces` and `peers`, and those of the others"});
        }
    }
    return findings;
}

std::set<std::string> NodesThatHear(const Gateway::Fleet &fleet)
{
    std::set<std::string> names;
    for (const Gateway::NodeStatus &node : fleet.nodes)
    {
        if (node.state == Gateway::NodeState::UP && std::isfinite(node.round_trip_s) &&
            node.round_trip_s >= 0)
        {
            names.insert(node.node);
        }
    }
    return names;
}

std::vector<Finding> OfTypes(const std::vector<FleetSession::Node> &nodes)
{
    std::vector<Finding> findings;
    for (const std::string &line : Offers::Differences(nodes))
    {
        findings.push_back({Level::Problem, "types", line, "build them from the same IDL"});
    }
    return findings;
}

std::vector<Finding> OfClocks(const std::vector<FleetSession::Node> &nodes, const Gateway::Fleet &fleet)
{
    std::vector<Finding> findings;
    std::size_t known = 0;
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const FleetSession::Node &node : nodes)
    {
        if (!std::isfinite(node.ClockAhead) || node.State == Gateway::NodeState::LOST)
        {
            continue;
        }
        ++known;
        least = std::min(least, node.ClockAhead);
        most = std::max(most, node.ClockAhead);
        if (std::abs(node.ClockAhead) > ClockTolerance + RoundTripOf(node.Name, fleet))
        {
            findings.push_back(
                {Level::Problem, "clock of " + node.Name,
                 Seconds(node.ClockAhead) + (node.ClockAhead < 0 ? " behind" : " ahead of") +
                     " this machine's; ages are right all the same, logs and recordings do not match",
                 "set it (chrony, or GPS)"});
        }
    }
    // If all nodes agree with each other, this machine's clock is the wrong one.
    if (findings.size() > 1 && findings.size() == known && most - least < ClockTolerance)
    {
        return {{Level::Problem, "clock of this machine",
                 Seconds(most) + (most < 0 ? " ahead of" : " behind") + " those of all " +
                     std::to_string(known) + " nodes",
                 "set it (chrony)"}};
    }
    if (findings.empty() && known > 0)
    {
        findings.push_back({Level::Good, "clocks",
                            "those of " + std::to_string(known) + " nodes differ by " +
                                Seconds(std::max(std::abs(least), std::abs(most))) + " at most"});
    }
    return findings;
}

std::vector<Finding> OfLinks(const std::vector<FleetSession::Node> &nodes, const Gateway::Fleet &fleet)
{
    std::vector<Finding> findings;
    std::size_t up = 0;
    for (const FleetSession::Node &node : nodes)
    {
        if (node.State == Gateway::NodeState::LOST)
        {
            continue;
        }
        ++up;
        for (const FleetExplorer::Strain &strain : node.Strains)
        {
            findings.push_back(OfStrain(node.Name, strain, fleet));
        }
    }
    if (findings.empty() && up > 0)
    {
        findings.push_back({Level::Good, "links", "no outbox fills, and no message is in doubt"});
    }
    return findings;
}

std::vector<Finding> OfLosses(const std::vector<FleetSession::Node> &nodes)
{
    std::vector<Finding> findings;
    std::uint64_t heard = 0;
    for (const FleetSession::Node &node : nodes)
    {
        const std::uint64_t all = node.BeatsHeard + node.BeatsMissed;
        heard += node.BeatsHeard;
        if (node.BeatsMissed == 0)
        {
            continue;
        }
        const bool isMuch =
            all >= FewBeats && static_cast<double>(node.BeatsMissed) > MuchLost * static_cast<double>(all);
        findings.push_back(
            {isMuch ? Level::Problem : Level::Note, "loss from " + node.Name,
             std::to_string(node.BeatsMissed) + " of " + std::to_string(all) + " beats did not come",
             "rabit check, rabit bytes: whether the radio is full (docs/how_to/radio.md); else a better "
             "signal"});
    }
    if (findings.empty() && heard > 0)
    {
        findings.push_back({Level::Good, "loss", "all of " + std::to_string(heard) + " beats came"});
    }
    return findings;
}

}  // namespace Rabit::Tool::Doctor
