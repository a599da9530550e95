#include "ReplayFleet.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

#include "Output.h"

namespace Rabit::Tool
{

using Replay::ReplayItem;
using Replay::ReplayStream;
using Replay::ReplayTimeline;

namespace
{

// Nanoseconds after a jump in which no node leaves: the records that tell of a node may come this late.
constexpr Replay::Time Grace = 2'000'000'000;
// Posts at shorter intervals, in nanoseconds: the recorded gateways skipped some of them, too.
constexpr Replay::Time Burst = 1'000'000;

std::set<std::string> RecordersIn(const Replay::ReplayPlan &plan)
{
    std::set<std::string> recorders;
    for (const ReplayStream &stream : plan.Streams)
    {
        if (stream.What == ReplayStream::Kind::Fleet)
        {
            recorders.insert(stream.Recorder);
        }
    }
    return recorders;
}

// Reads the sample by the type in the file: Fleet may have had other members when it was recorded.
std::vector<Replay::ReplayPresence::Known> NodesIn(const DynamicType &type, const Mcap::Bytes &sample)
{
    std::vector<Replay::ReplayPresence::Known> known;
    const auto json = nlohmann::json::parse(type.ToJson(sample).value_or("{}"), nullptr, false);
    for (const auto &node : json.is_object() ? json.value("nodes", nlohmann::json::array()) : json)
    {
        if (node.contains("node") && node.contains("state") && node["node"].is_string())
        {
            known.push_back({node["node"], node["state"] == "LOST"});
        }
    }
    return known;
}

}  // namespace

ReplayFleet::ReplayFleet(const Replay::ReplayPlan &plan, const Replay::NodeRenames &renames,
                         const GatewayConfig &network, const CommonOptions &options, Wakeup &wakeup)
    : _plan(plan),
      _renames(renames),
      _network(network),
      _options(options),
      _wakeup(wakeup),
      _presence(RecordersIn(plan)),
      _times(plan.Streams.size()),
      _lastPosted(plan.Streams.size())
{
    for (const ReplayStream &stream : plan.Streams)
    {
        _streams.push_back(Prepare(stream));
    }
}

ReplayFleet::Stream ReplayFleet::Prepare(const ReplayStream &stream)
{
    const std::string name = stream.What == ReplayStream::Kind::Queue ? stream.Peer + "/" + stream.Name
                                                                      : stream.Node + "/" + stream.Name;
    const ParsedType parsed = DynamicType::Parse(stream.IdlText, stream.Type);
    if (!parsed.Type)
    {
        Output::Talk(name + ": its type cannot be used, and it is not played: " + parsed.Reason);
        return {};
    }
    if (stream.What == ReplayStream::Kind::Fleet)
    {
        return {nullptr, parsed.Type};
    }
    const MessageType *type = DynamicType::Register(parsed.Type);
    if (type == nullptr)
    {
        Output::Talk(name + ": it has another definition of `" + stream.Type +
                     "` than what is played already; it is not played");
        return {};
    }
    if (stream.What == ReplayStream::Kind::Message)
    {
        const auto [entry, isNew] = _messages.try_emplace(name, stream.Type);
        if (!isNew && entry->second != stream.Type)
        {
            Output::Talk(name + " is played as `" + entry->second + "`; what there is of it as `" +
                         stream.Type + "` is not played");
            return {};
        }
    }
    return {type, nullptr};
}

std::vector<std::string> ReplayFleet::Names() const
{
    std::vector<std::string> names;
    for (const std::string &node : _plan.Nodes)
    {
        names.push_back(_renames.NewNameOf(node));
    }
    return names;
}

std::vector<ReplayNode::Topic> ReplayFleet::TopicsOf(const std::string &node) const
{
    std::vector<ReplayNode::Topic> topics;
    for (std::size_t at = 0; at < _streams.size(); ++at)
    {
        const ReplayStream &stream = _plan.Streams[at];
        const bool isOfNode = stream.What == ReplayStream::Kind::Message && stream.Node == node;
        if (isOfNode && _streams[at].Type != nullptr &&
            std::none_of(topics.begin(), topics.end(),
                         [&stream](const ReplayNode::Topic &topic) { return topic.Message == stream.Name; }))
        {
            topics.push_back({stream.Name, _streams[at].Type, stream.Qos});
        }
    }
    return topics;
}

void ReplayFleet::Note(const ReplayItem &item)
{
    const ReplayStream &stream = _plan.Streams[item.Stream];
    if (stream.What != ReplayStream::Kind::Fleet)
    {
        _presence.Heard(stream.Node, stream.Recorder, item.LogTime);
    }
    else if (_streams[item.Stream].OfFleet)
    {
        _presence.Told(stream.Recorder, stream.Name, item.LogTime,
                       NodesIn(*_streams[item.Stream].OfFleet, item.Data));
    }
}

void ReplayFleet::Begin(const std::vector<ReplayItem> &known, Replay::Time at)
{
    for (const ReplayItem &item : known)
    {
        Note(item);
    }
    _jumpedTo = at;
    Follow(at);
}

void ReplayFleet::Jump(const std::vector<ReplayTimeline::Due> &restored, Replay::Time to)
{
    _presence.Reset();
    for (const ReplayTimeline::Due &due : restored)
    {
        Note(due.Item);
    }
    _jumpedTo = to;
    Follow(to);
    for (const ReplayTimeline::Due &due : restored)
    {
        // A node that had left by then does not post.
        const ReplayStream &stream = _plan.Streams[due.Item.Stream];
        if (stream.What == ReplayStream::Kind::Message && _presence.IsThere(stream.Node, to))
        {
            Post(due);
        }
    }
}

void ReplayFleet::Play(const ReplayTimeline::Due &due)
{
    Note(due.Item);
    switch (_plan.Streams[due.Item.Stream].What)
    {
        case ReplayStream::Kind::Message:
            Post(due);
            break;
        case ReplayStream::Kind::Queue:
            Send(due.Item);
            break;
        default:
            Follow(due.Item.LogTime);
            break;
    }
}

void ReplayFleet::Post(const ReplayTimeline::Due &due)
{
    const ReplayStream &stream = _plan.Streams[due.Item.Stream];
    if (_streams[due.Item.Stream].Type == nullptr)
    {
        return;
    }
    Come(stream.Node);
    ReplayNode &node = *_nodes.at(stream.Node);
    // Messages that were posted one by one stay so, even if this program is late.
    Replay::Time &last = _lastPosted[due.Item.Stream];
    const Replay::Time gap = std::max(last, due.Item.LogTime) - std::min(last, due.Item.LogTime);
    last = due.Item.LogTime;
    if (_waitsForTurns || gap >= Burst)
    {
        node.WaitForItsTurn(stream.Name);
    }
    const PostTime now = RabitClock::System()->Now();
    const Duration posted = _times.Of(due.Item.Stream, now.Monotonic, due.Age);
    const double age = std::chrono::duration<double>(now.Monotonic - posted).count();
    if (!node.Post(stream.Name, due.Item.Data, {now.GpsTimeSeconds - age, posted}))
    {
        ++_counts.Undecodable;
        return;
    }
    ++(due.IsRestored ? _counts.Restored : _counts.Messages);
}

void ReplayFleet::Send(const ReplayItem &item)
{
    const ReplayStream &stream = _plan.Streams[item.Stream];
    if (_streams[item.Stream].Type == nullptr)
    {
        return;
    }
    Come(stream.Node);
    ++_counts.QueueMessages;
    const std::string address = _renames.RuledNameOf(stream.Peer) + "/" + stream.Name;
    _nodes.at(stream.Node)->Send(address, *_streams[item.Stream].Type, item.Data, _receipt);
}

void ReplayFleet::Follow(Replay::Time position)
{
    for (const std::string &node : _plan.Nodes)
    {
        if (_keepsAll || _presence.IsThere(node, position))
        {
            Come(node);
        }
        else if (position > _jumpedTo + Grace)
        {
            Leave(node);
        }
    }
}

void ReplayFleet::Come(const std::string &node)
{
    std::unique_ptr<ReplayNode> &there = _nodes[node];
    if (!there)
    {
        there = std::make_unique<ReplayNode>(_network, _renames.NewNameOf(node), TopicsOf(node), _options,
                                             _wakeup);
    }
}

void ReplayFleet::Leave(const std::string &node)
{
    const auto there = _nodes.find(node);
    if (there == _nodes.end() || !there->second)
    {
        return;
    }
    _counts.Replaced += there->second->Replaced();
    _nodes.erase(there);
    for (std::size_t at = 0; at < _plan.Streams.size(); ++at)
    {
        if (_plan.Streams[at].Node == node)
        {
            _times.Forget(at);
        }
    }
}

std::string ReplayFleet::TwiceName() const
{
    const auto twice =
        std::find_if(_nodes.begin(), _nodes.end(),
                     [](const auto &entry) { return entry.second && entry.second->IsTwice(); });
    return twice == _nodes.end() ? "" : _renames.NewNameOf(twice->first);
}

ReplayFleet::Counts ReplayFleet::CountsNow() const
{
    Counts counts = _counts;
    counts.AgesNotKept = _times.NotKept();
    const RabitQueueReceipt::Counts sent = _receipt->GetCounts();
    counts.Undelivered = counts.QueueMessages - std::min<std::uint64_t>(counts.QueueMessages, sent.Delivered);
    for (const auto &[name, node] : _nodes)
    {
        counts.Replaced += node ? node->Replaced() : 0;
    }
    return counts;
}

}  // namespace Rabit::Tool
