#include "manager/Exploration.h"

#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <set>
#include <stdexcept>

#include "clocks/GpsTime.h"
#include "wire/ForeignReport.h"

namespace Rabit
{
namespace
{

double ClockAhead(const PeerTable::Peer &peer, const PostTime &now)
{
    const auto source = peer.Clock.Source();
    if (!source)
    {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const auto wall = now.Monotonic - source->ToLocal + peer.Clock.SourceToWall();
    const std::chrono::nanoseconds own(GpsTime::ToUtcNanoseconds(now.GpsTimeSeconds));
    return std::chrono::duration<double>(wall - own).count();
}

FleetExplorer::Strain::Kind KindOf(LinkStrain::Kind kind)
{
    using Kind = FleetExplorer::Strain::Kind;
    return kind == LinkStrain::Kind::Filling   ? Kind::Filling
           : kind == LinkStrain::Kind::InDoubt ? Kind::InDoubt
                                               : Kind::HeldBack;
}

std::vector<FleetExplorer::Strain> StrainsOf(const PeerTable::Peer &peer,
                                             const std::vector<const PeerTable::Peer *> &heard)
{
    std::vector<FleetExplorer::Strain> strains;
    for (const LinkStrain &said : peer.Strains)
    {
        const auto other =
            std::find_if(heard.begin(), heard.end(),
                         [&said](const PeerTable::Peer *one) { return one->Tag == said.Node; });
        strains.push_back({.What = KindOf(said.What),
                           .Other = other == heard.end() ? "" : (*other)->Node,
                           .Percent = said.Percent,
                           .Messages = said.Messages});
    }
    return strains;
}

NodeReports::Kind KindOf(FleetExplorer::Report report)
{
    using Report = FleetExplorer::Report;
    return report == Report::Air         ? NodeReports::Kind::Air
           : report == Report::LastLines ? NodeReports::Kind::LastLines
           : report == Report::LinesFrom ? NodeReports::Kind::LinesFrom
           : report == Report::Foreign   ? NodeReports::Kind::Foreign
           : report == Report::Agreement ? NodeReports::Kind::Agreement
                                         : NodeReports::Kind::Echo;
}

}  // namespace

std::vector<FleetExplorer::Node> Exploration::Nodes() const
{
    const std::lock_guard lock(_mutex);
    return _nodes;
}

std::vector<std::string> Exploration::Tools() const
{
    const std::lock_guard lock(_mutex);
    return _tools;
}

void Exploration::AskForType(const std::string &node, const std::string &type, std::uint64_t definition)
{
    {
        const std::lock_guard lock(_mutex);
        _lacking[{definition, ""}] = {node, type, definition};
    }
    _wake();
}

std::optional<std::string> Exploration::TypeText(std::uint64_t definition) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _texts.find(definition);
    return found == _texts.end() ? std::nullopt : std::optional(found->second);
}

void Exploration::AskForReport(const std::string &node, Report what, std::uint32_t argument)
{
    const NodeReports::Kind kind = KindOf(what);
    {
        const std::lock_guard lock(_mutex);
        _reports[{node, kind}] = {argument, std::nullopt};
        _lacking[{NodeReports::NameOf(kind), node}] = {node, "", NodeReports::NameOf(kind, argument)};
    }
    _wake();
}

std::optional<FleetExplorer::Answer> Exploration::TakeReport(const std::string &node, Report what)
{
    const std::lock_guard lock(_mutex);
    const auto found = _reports.find({node, KindOf(what)});
    return found == _reports.end() ? std::nullopt : std::exchange(found->second.second, std::nullopt);
}

std::vector<Gateway::ForeignTopic> FleetExplorer::ForeignTopicsIn(std::string_view report)
{
    return ForeignReport::TopicsIn(report);
}

void Exploration::LookForSubscribers(const std::vector<std::string> &messages)
{
    {
        const std::lock_guard lock(_mutex);
        _requests.LookedFor = messages;
    }
    _wake();
}

std::optional<std::map<std::string, FleetExplorer::Subscribers>> Exploration::FoundSubscribers() const
{
    const std::lock_guard lock(_mutex);
    return _subscribers;
}

void Exploration::FindSubscribers(const std::vector<std::string> &messages,
                                  const std::vector<const TransportSession *> &sessions)
{
    std::set<std::string> nodes;
    for (const Node &node : Nodes())
    {
        nodes.insert(node.Name);
    }
    std::map<std::string, Subscribers> all;
    for (const std::string &message : messages)
    {
        std::set<std::string> reading;
        std::set<std::string> types;
        std::set<WriterId> others;  // a program may be there on several paths
        Subscribers &subscribers = all[message];
        for (const TransportSession *session : sessions)
        {
            for (const RemoteEndpoint &endpoint : session->RemoteEndpointsOn(message))
            {
                if (endpoint.IsWriter)
                {
                    continue;
                }
                types.insert(endpoint.Type);
                if (endpoint.Node.empty())
                {
                    others.insert(endpoint.Id);
                }
                else if (nodes.contains(endpoint.Node))
                {
                    reading.insert(endpoint.Node);
                }
            }
        }
        subscribers.Others = others.size();
        subscribers.Nodes.assign(reading.begin(), reading.end());
        subscribers.Types.assign(types.begin(), types.end());
    }
    {
        const std::lock_guard lock(_mutex);
        _subscribers = std::move(all);
    }
    Tell();
}

void Exploration::Subscribe(const SubscribeRule &rule)
{
    if (MessageTypeRegistry::Find(rule.Type) == nullptr)
    {
        throw std::invalid_argument("subscribe " + rule.Message + ": no type `" + rule.Type +
                                    "` is registered");
    }
    {
        const std::lock_guard lock(_mutex);
        _requests.Subscriptions.push_back(rule);
    }
    _wake();
}

void Exploration::SetExpiry(const std::string &node, const std::string &queue,
                            std::chrono::milliseconds expire)
{
    if (expire < std::chrono::milliseconds(0) || expire > std::chrono::hours(24 * 365))
    {
        throw std::invalid_argument("SetExpiry: a message expires after 0 s to a year");
    }
    const std::lock_guard lock(_mutex);
    _expiries.emplace_back(node, queue, expire);
    if (_links)
    {
        _links(node, queue, expire);
    }
}

void Exploration::SetLinks(Expiry links)
{
    const std::lock_guard lock(_mutex);
    _links = std::move(links);
    for (const auto &[node, queue, expire] : _expiries)
    {
        if (_links)
        {
            _links(node, queue, expire);
        }
    }
}

bool Exploration::WaitUntilTaken(std::chrono::nanoseconds limit)
{
    const std::uint64_t turn = ++_turnsAsked;
    _wake();
    std::unique_lock lock(_mutex);
    _turnDone.wait_for(lock, limit, [this, turn] { return _turnsDone >= turn || !_isServed; });
    return _turnsDone >= turn;
}

void Exploration::EndTurn(std::uint64_t asked)
{
    if (asked == _turnsDone)  // written by this thread alone
    {
        return;
    }
    {
        const std::lock_guard lock(_mutex);
        _turnsDone = asked;
    }
    _turnDone.notify_all();
}

void Exploration::SetServed(bool isServed)
{
    {
        const std::lock_guard lock(_mutex);
        _isServed = isServed;
    }
    _turnDone.notify_all();
}

void Exploration::SetOnChange(std::function<void()> onChange)
{
    const std::lock_guard lock(_mutex);
    _onChange = std::move(onChange);
}

Exploration::Requests Exploration::TakeRequests()
{
    const std::lock_guard lock(_mutex);
    Requests requests = std::exchange(_requests, {});
    for (const auto &[key, wanted] : _lacking)
    {
        requests.Lacking.push_back(wanted);
    }
    return requests;
}

void Exploration::SetNodes(const PeersOverPaths &peers, const ProblemTexts &problems, const PostTime &now)
{
    std::vector<Node> nodes;
    const std::vector<const PeerTable::Peer *> heard = peers.Heard();
    std::uint32_t sum = 0;  // BeatExtensions::FleetSum
    for (const PeerTable::Peer *peer : heard)
    {
        sum += peer->State == Gateway::NodeState::LOST ? 0 : peer->Tag;
    }
    for (const PeerTable::Peer *peer : heard)
    {
        nodes.push_back({peer->Node, peer->State, peer->Incarnation, peer->Offers, peer->Twice,
                         ClockAhead(*peer, now), peer->Beats.Heard(), peer->Beats.Missed(),
                         std::chrono::duration<double>(peer->Period).count(), StrainsOf(*peer, heard),
                         problems.AreTold(peer->Node), peer->FleetSum == sum});
    }
    {
        const std::lock_guard lock(_mutex);
        _nodes = std::move(nodes);
        _tools = peers.HeardTools();
    }
    Tell();
}

void Exploration::AddText(std::uint64_t definition, std::string text)
{
    {
        const std::lock_guard lock(_mutex);
        _texts[definition] = std::move(text);
        _lacking.erase({definition, ""});
    }
    Tell();
}

void Exploration::AddReport(const std::string &node, NodeReports::Name name, Answer answer)
{
    {
        const std::lock_guard lock(_mutex);
        const auto found = _reports.find({node, name.What});
        if (found == _reports.end() || found->second.first != name.Argument)
        {
            return;  // another one was requested meanwhile
        }
        found->second.second = std::move(answer);
        _lacking.erase({NodeReports::NameOf(name.What), node});
    }
    Tell();
}

void Exploration::Tell()
{
    std::function<void()> onChange;
    {
        const std::lock_guard lock(_mutex);
        onChange = _onChange;
    }
    if (onChange)
    {
        onChange();
    }
}

}  // namespace Rabit
