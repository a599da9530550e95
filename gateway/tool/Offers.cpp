#include "Offers.h"

#include <rabit/base/ListedNames.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/idl/NearestWord.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cstdio>
#include <tuple>

#include "Table.h"

namespace Rabit::Tool::Offers
{

std::vector<Message> MessagesOf(const std::vector<FleetSession::Node> &nodes)
{
    std::map<std::tuple<std::string, std::string, std::uint64_t, std::string>, Message> messages;
    for (const FleetSession::Node &node : nodes)
    {
        if (!node.Offers || node.State == Gateway::NodeState::LOST)
        {
            continue;
        }
        for (const Gateway::PublishedMessage &published : node.Offers->publishes)
        {
            Message &message =
                messages[{published.message, published.type, published.definition, published.qos}];
            message.Name = published.message;
            message.Type = published.type;
            message.Qos = published.qos;
            message.Definition = published.definition;
            message.Publishers.push_back(node.Name);
        }
    }
    std::vector<Message> list;
    for (auto &[key, message] : messages)
    {
        list.push_back(std::move(message));
    }
    return list;
}

std::map<std::string, Definitions> TypesOf(const std::vector<FleetSession::Node> &nodes)
{
    std::map<std::string, Definitions> types;
    for (const FleetSession::Node &node : nodes)
    {
        if (!node.Offers || node.State == Gateway::NodeState::LOST)
        {
            continue;
        }
        for (const Gateway::PublishedMessage &published : node.Offers->publishes)
        {
            types[published.type][published.definition].insert(node.Name);
        }
        for (const Gateway::AcceptedQueue &accepted : node.Offers->accepts)
        {
            for (const Gateway::QueueType &type : accepted.types)
            {
                types[type.type][type.definition].insert(node.Name);
            }
        }
    }
    return types;
}

std::vector<std::string> Differences(const std::vector<FleetSession::Node> &nodes)
{
    std::vector<std::string> lines;
    for (const auto &[type, definitions] : TypesOf(nodes))
    {
        if (definitions.size() < 2)
        {
            continue;
        }
        std::string line = "nodes were built with different definitions of `" + type + "`: ";
        for (const auto &[definition, names] : definitions)
        {
            line += (definition == definitions.begin()->first ? "" : "; ") +
                    boost::algorithm::join(names, ", ") + " with " + HashText(definition);
        }
        lines.push_back(line);
    }
    return lines;
}

bool AreComplete(const std::vector<FleetSession::Node> &nodes)
{
    return std::all_of(nodes.begin(), nodes.end(),
                       [](const FleetSession::Node &node)
                       { return node.Offers || node.State == Gateway::NodeState::LOST; });
}

bool DoAllHearTheSame(const std::vector<FleetSession::Node> &nodes)
{
    std::size_t live = 0;
    for (const FleetSession::Node &node : nodes)
    {
        if (node.State != Gateway::NodeState::LOST)
        {
            if (!node.HearsTheSame)
            {
                return false;
            }
            ++live;
        }
    }
    return live > 0;
}

double SecondsToHearEverybody(const std::vector<FleetSession::Node> &nodes)
{
    double seconds = 1.5;
    for (const FleetSession::Node &node : nodes)
    {
        seconds = std::max(seconds, 2.0 * node.BeatPeriod);
    }
    return seconds;
}

bool AreAllThere(const std::vector<FleetSession::Node> &nodes, const std::string &pattern,
                 bool isEverybodyHeard)
{
    const auto isLost = [](const FleetSession::Node &node) { return node.State == Gateway::NodeState::LOST; };
    const FleetSession::Node *const named = FindNode(nodes, pattern);
    if (named != nullptr && !isLost(*named))
    {
        return named->Offers.has_value();
    }
    return isEverybodyHeard && !nodes.empty() &&
           std::all_of(nodes.begin(), nodes.end(),
                       [&](const FleetSession::Node &node)
                       { return node.Offers || isLost(node) || !MatchesPattern(pattern, node.Name); });
}

std::string NoSuchNode(const std::string &name, const std::vector<FleetSession::Node> &nodes, double seconds)
{
    const auto digits = [](std::string text)
    {
        std::erase_if(text, [](char c) { return c < '0' || c > '9'; });
        return text;
    };
    std::vector<std::string> there;
    std::vector<std::string> similar;
    std::string text = "node `" + name + "` was not heard within " + NumberText(seconds, 1, " s");
    for (const FleetSession::Node &node : nodes)
    {
        if (node.State == Gateway::NodeState::LOST)
        {
            text = node.Name == name ? "node `" + name + "` is LOST" : text;
            continue;
        }
        there.push_back(node.Name);
        if (digits(node.Name) == digits(name))
        {
            similar.push_back(node.Name);
        }
    }
    const std::string hint = NearestWordHint(name, similar);
    if (hint.starts_with("; did you mean"))
    {
        return text + hint;
    }
    return text + (there.empty() ? "" : "; there: " + ListedNames(there));
}

std::string HashText(std::uint64_t definition)
{
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(definition));
    return text;
}

}  // namespace Rabit::Tool::Offers
