#include "Samples.h"

#include <rabit/base/ListedNames.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "Offers.h"
#include "Output.h"

namespace Rabit::Tool
{
namespace
{

std::pair<std::string, std::string> Split(const std::string &what)
{
    const std::size_t slash = what.find('/');
    return slash == std::string::npos ? std::pair<std::string, std::string>("*", what)
                                      : std::pair(what.substr(0, slash), what.substr(slash + 1));
}

const Gateway::PublishedMessage *FindIn(const FleetSession::Node &node, const std::string &message)
{
    if (!node.Offers || node.State == Gateway::NodeState::LOST)
    {
        return nullptr;
    }
    const auto &all = node.Offers->publishes;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&message](const Gateway::PublishedMessage &published)
                                    { return published.message == message; });
    return found == all.end() ? nullptr : &*found;
}

}  // namespace

Samples::Samples(FleetSession &session, const std::string &what) : _session(session)
{
    std::tie(_pattern, _message) = Split(what);
}

Samples::Samples(FleetSession &session, const ForeignArgument &topic)
    : _session(session), _message(topic.Rule.Local), _typeName(topic.Rule.Type)
{
    _type.Type = topic.Type;
    Follow("", topic.Rule.Local);
}

std::vector<const FleetSession::Node *> Samples::Publishers(
    const std::vector<FleetSession::Node> &nodes) const
{
    std::vector<const FleetSession::Node *> publishers;
    for (const FleetSession::Node &node : nodes)
    {
        if (MatchesPattern(_pattern, node.Name) && FindIn(node, _message) != nullptr)
        {
            publishers.push_back(&node);
        }
    }
    return publishers;
}

void TellNobodyPublishes(const FleetSession &session, const std::string &pattern, const std::string &message)
{
    const std::vector<FleetSession::Node> nodes = session.Nodes();
    std::vector<std::string> matching;
    std::vector<std::string> messages;
    for (const FleetSession::Node &node : nodes)
    {
        if (node.State == Gateway::NodeState::LOST || !MatchesPattern(pattern, node.Name))
        {
            continue;
        }
        matching.push_back(node.Name);
        if (!node.Offers)
        {
            Output::Talk("no announcement of " + node.Name + " has come yet");
            continue;
        }
        for (const auto &published : node.Offers->publishes)
        {
            messages.push_back(published.message);
        }
    }
    if (matching.empty())
    {
        Output::Talk(session.NoSuchNode(pattern));
    }
    else
    {
        Output::Talk(ListedNames(matching) + (matching.size() == 1 ? " does" : " do") + " not publish `" +
                     message + "`" + NearestWordHint(message, messages));
    }
}

int Samples::Open(double until)
{
    _session.WaitForOffers(_pattern, [this] { return !Publishers(_session.Nodes()).empty(); });
    const std::vector<FleetSession::Node> nodes = _session.Nodes();
    if (nodes.empty())
    {
        return _session.NobodyThere();
    }
    const auto publishers = Publishers(nodes);
    if (publishers.empty())
    {
        TellNobodyPublishes(_session, _pattern, _message);
        return ProblemFound;
    }
    const Gateway::PublishedMessage &first = *FindIn(*publishers.front(), _message);
    _typeName = first.type;
    _definition = first.definition;
    std::vector<std::string> holders;
    for (const FleetSession::Node *node : publishers)
    {
        if (FindIn(*node, _message)->definition == _definition)
        {
            holders.push_back(node->Name);
        }
    }
    _type = FetchType(_session, holders, _typeName, _definition, std::max(until, _session.Seconds() + 2.0));
    if (_type.Type && DynamicType::Register(_type.Type) == nullptr)
    {
        _type.Type = nullptr;
        _type.Reason = "this program has another definition of `" + _typeName + "`";
    }
    if (!_type.Type)
    {
        Output::Talk(_type.Reason);
        return ProblemFound;
    }
    FollowNew();
    SubscribeRule rule;
    rule.Message = _message;
    rule.Type = _typeName;
    rule.From = {_pattern};
    _session.Explorer().Subscribe(rule);
    return Good;
}

// Leaves out nodes that were built with another definition: their bytes would be misread.
void Samples::FollowNew()
{
    const std::vector<FleetSession::Node> nodes = _session.Nodes();
    for (const FleetSession::Node *node : Publishers(nodes))
    {
        if (_followed.count(node->Name) > 0)
        {
            continue;
        }
        const Gateway::PublishedMessage &published = *FindIn(*node, _message);
        if (published.type == _typeName && published.definition == _definition)
        {
            Follow(node->Name, node->Name + "/" + _message);
        }
        else
        {
            _followed[node->Name] = nullptr;
            Output::Talk(node->Name + " publishes `" + _message + "` as another type (" + published.type +
                         ", " + Offers::HashText(published.definition) + "); it is left out");
        }
    }
}

void Samples::Follow(const std::string &node, const std::string &local)
{
    auto message = std::make_shared<DynamicMessage>(_type.Type);
    _followed[node] = message;
    if (!_session.Workspace().AddPublishSubscribeMessage(local, message))
    {
        return;
    }
    // The handler fetches into a message of its own: it runs on the transport's thread.
    auto fetched = std::make_shared<DynamicMessage>(_type.Type);
    const auto global = message->GetGlobalPublishSubscribeMessageRef();
    fetched->SetGlobalPublishSubscribeMessageRef(global);
    // The posts of one node come one after the other. A quick handler runs within each post, so it sees every
    // value.
    global->ConnectSomethingPublished(RabitQuickHandler(
        [inbox = _inbox, fetched, node, &session = _session]
        {
            if (!fetched->FetchMessage())
            {
                return;
            }
            Sample sample;
            sample.Node = node;
            sample.Bytes = fetched->Sample();
            sample.Age = fetched->GetAgeSeconds();
            sample.Stamp = fetched->GetTimeStamp();
            sample.At = session.Seconds();
            {
                const std::lock_guard lock(inbox->Mutex);
                if (inbox->Bytes + sample.Bytes.size() > MostBytes)
                {
                    ++inbox->Missed;
                    return;
                }
                inbox->Bytes += sample.Bytes.size();
                inbox->Waiting.push_back(std::move(sample));
            }
            session.Notify();
        }));
}

std::vector<Sample> Samples::Take(double until)
{
    std::vector<Sample> samples;
    _session.WaitUntil(until,
                       [&]
                       {
                           FollowNew();
                           const std::lock_guard lock(_inbox->Mutex);
                           samples.swap(_inbox->Waiting);
                           _inbox->Bytes = 0;
                           return !samples.empty();
                       });
    return samples;
}

std::uint64_t Samples::Missed() const
{
    const std::lock_guard lock(_inbox->Mutex);
    return _inbox->Missed;
}

int ListenTo(const CommonOptions &options, const std::string &what, const ForeignOptions &foreign,
             Wakeup &wakeup, const std::function<int(FleetSession &session, Samples &samples)> &body)
{
    GatewayConfig config = ConfigOf(options);
    std::vector<std::string> messages{what};
    const std::vector<ForeignArgument> topics = TakeForeign(foreign, messages);
    if (!topics.empty())
    {
        AddForeign(topics, config);
        config.Tool->AsksOf = {config.Node};
        std::optional<Samples> samples;
        FleetSession session(config, options, wakeup,
                             [&](FleetSession &joining) { samples.emplace(joining, topics.front()); });
        return body(session, *samples);
    }
    config.Tool->AsksOf = {Split(what).first};  // no other announcements are needed
    FleetSession session(config, options, wakeup);
    Samples samples(session, what);
    const int code = samples.Open(options.Wait);
    return code == Good ? body(session, samples) : code;
}

}  // namespace Rabit::Tool
