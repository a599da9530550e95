#include "FleetFollower.h"

#include <rabit/gateway/NamePattern.h>

#include <algorithm>

#include "FleetType.h"
#include "Offers.h"
#include "Output.h"
#include "Samples.h"

namespace Rabit::Tool
{
namespace
{

constexpr double TypeWait = 2.0;
// Seconds after which a message that nobody publishes is reported.
constexpr double Patience = 2.0;
// Seconds until a type is requested again that no node has handed out.
constexpr double Pause = 5.0;

}  // namespace

FleetFollower::FleetFollower(FleetSession &session, const std::vector<std::string> &what,
                             GatewayConfig &config, std::vector<std::string> &except)
    : _session(session), _config(config), _except(except)
{
    for (const std::string &one : what)
    {
        const std::size_t slash = one.find('/');
        _patterns.push_back(slash == std::string::npos
                                ? Pattern{.Node = "*", .Message = one}
                                : Pattern{.Node = one.substr(0, slash), .Message = one.substr(slash + 1)});
    }
}

std::vector<std::string> FleetFollower::NodesOf(const std::vector<std::string> &what)
{
    std::vector<std::string> nodes;
    for (const std::string &one : what)
    {
        const std::size_t slash = one.find('/');
        std::string node = slash == std::string::npos ? "*" : one.substr(0, slash);
        if (std::find(nodes.begin(), nodes.end(), node) == nodes.end())
        {
            nodes.push_back(std::move(node));
        }
    }
    return nodes;
}

bool FleetFollower::IsWanted(const std::string &node, const std::string &message) const
{
    return std::any_of(
        _patterns.begin(), _patterns.end(),
        [&](const Pattern &pattern)
        { return MatchesPattern(pattern.Node, node) && MatchesPattern(pattern.Message, message); });
}

std::vector<std::string> FleetFollower::From(const std::string &message) const
{
    std::vector<std::string> from;
    for (const Pattern &pattern : _patterns)
    {
        if (MatchesPattern(pattern.Message, message) &&
            std::find(from.begin(), from.end(), pattern.Node) == from.end())
        {
            from.push_back(pattern.Node);
        }
    }
    return from;
}

std::vector<std::string> FleetFollower::FollowNew()
{
    std::vector<std::string> followed;
    for (const FleetSession::Node &node : _session.Nodes())
    {
        if (!node.Offers || node.State == Gateway::NodeState::LOST)
        {
            continue;
        }
        for (const Gateway::PublishedMessage &published : node.Offers->publishes)
        {
            const std::string name = node.Name + "/" + published.message;
            if (_seen.count(name) == 0 && IsWanted(node.Name, published.message) &&
                !MatchesAny(_except, name) && Follow(node.Name, published))
            {
                _seen.insert(name);
                if (!MatchesAny(_except, name))
                {
                    followed.push_back(name);
                }
            }
        }
    }
    return followed;
}

void FleetFollower::TellOfMissing()
{
    const std::vector<FleetSession::Node> nodes = _session.Nodes();
    for (Pattern &pattern : _patterns)
    {
        if (pattern.IsChecked || pattern.Message == "*" || _session.Seconds() < Patience ||
            !Offers::AreAllThere(nodes, pattern.Node, _session.IsEverybodyHeard()))
        {
            continue;
        }
        pattern.IsChecked = true;
        const bool isPublished = std::any_of(
            nodes.begin(), nodes.end(),
            [&pattern](const FleetSession::Node &node)
            {
                return MatchesPattern(pattern.Node, node.Name) && node.Offers &&
                       std::any_of(node.Offers->publishes.begin(), node.Offers->publishes.end(),
                                   [&pattern](const Gateway::PublishedMessage &published)
                                   { return MatchesPattern(pattern.Message, published.message); });
            });
        if (!isPublished)
        {
            TellNobodyPublishes(_session, pattern.Node, pattern.Message);
        }
    }
}

// Returns false if the type did not come, so that the call must be repeated later.
bool FleetFollower::Follow(const std::string &node, const Gateway::PublishedMessage &published)
{
    const std::string &message = published.message;
    if (const auto known = _followed.find(message); known != _followed.end())
    {
        if (known->second.Type != published.type || known->second.Definition != published.definition)
        {
            LeaveOut(node, message, "as another type");
        }
        return true;
    }
    const std::string name = node + "/" + message;
    if (const auto wait = _notBefore.find(name);
        wait != _notBefore.end() && _session.Seconds() < wait->second)
    {
        return false;
    }
    const FleetType type =
        FetchType(_session, {node}, published.type, published.definition, _session.Seconds() + TypeWait);
    if (type.Text.empty())
    {
        _notBefore[name] = _session.Seconds() + Pause;
        Output::Talk(name + ": " + type.Reason);
        return false;
    }
    if (!type.Type)
    {
        LeaveOut(node, message, "as a type that cannot be read (" + type.Reason + ")");
        return true;
    }
    if (DynamicType::Register(type.Type) == nullptr)
    {
        LeaveOut(node, message, "as `" + published.type + "`, of which this program has another definition");
        return true;
    }
    SubscribeRule rule;
    rule.Message = message;
    rule.Type = published.type;
    rule.From = From(message);
    _config.Subscribe.push_back(rule);
    _followed[message] = {published.type, published.definition};
    _session.Explorer().Subscribe(rule);
    return true;
}

void FleetFollower::LeaveOut(const std::string &node, const std::string &message, const std::string &reason)
{
    _except.push_back(node + "/" + message);
    Output::Talk(node + " publishes `" + message + "` " + reason + "; it is left out");
}

}  // namespace Rabit::Tool
