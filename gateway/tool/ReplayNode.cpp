#include "ReplayNode.h"

#include <rabit/gateway/QosProfileWords.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "Output.h"

namespace Rabit::Tool
{
namespace
{

// A gateway that takes longer is stuck. Values may then be replaced, which is counted.
constexpr std::chrono::milliseconds LongestTurn{10'000};
// Period of looking for Ctrl-C meanwhile; also the longest wait for a stuck gateway.
constexpr std::chrono::milliseconds LookForCtrlC{100};

GatewayConfig ConfigFor(GatewayConfig config, const std::string &name,
                        const std::vector<ReplayNode::Topic> &topics)
{
    config.Node = name;
    config.Tool.reset();
    config.Replay = true;
    for (const ReplayNode::Topic &topic : topics)
    {
        PublishRule rule;
        rule.Message = topic.Message;
        rule.Type = topic.Type->Name();
        rule.Qos = ProfileOf(topic.Qos).value_or(QosProfile::State);
        config.Publish.push_back(std::move(rule));
    }
    return config;
}

}  // namespace

ReplayNode::ReplayNode(GatewayConfig network, const std::string &name, const std::vector<Topic> &topics,
                       const CommonOptions &options, Wakeup &wakeup)
    : _name(name), _wakeup(wakeup), _session(ConfigFor(std::move(network), name, topics), options, wakeup)
{
    for (const Topic &topic : topics)
    {
        Posted posted{topic.Type->CreateShared(), topic.Type};
        if (_session.Workspace().AddPublishSubscribeMessage(topic.Message, posted.Message))
        {
            _posted.emplace(topic.Message, std::move(posted));
        }
        else
        {
            Output::Talk(name + "/" + topic.Message +
                         ": the name is taken by another message; it is not played");
        }
    }
}

bool ReplayNode::Post(const std::string &message, std::span<const std::uint8_t> sample, const PostTime &time)
{
    const auto found = _posted.find(message);
    if (found == _posted.end() || !found->second.Type->Deserialize(sample, *found->second.Message))
    {
        return false;
    }
    found->second.Message->PostMessage(time);
    found->second.Waits = true;
    return true;
}

void ReplayNode::WaitForItsTurn(const std::string &message)
{
    const auto found = _posted.find(message);
    if (found == _posted.end() || !found->second.Waits)
    {
        return;
    }
    const auto end = std::chrono::steady_clock::now() + (_isStuck ? LookForCtrlC : LongestTurn);
    bool isTaken = false;
    while (!isTaken && !_wakeup.IsInterrupted() && std::chrono::steady_clock::now() < end)
    {
        isTaken = _session.Explorer().WaitUntilTaken(LookForCtrlC);
    }
    _isStuck = !isTaken;
    for (auto &[name, posted] : _posted)
    {
        posted.Waits = false;
    }
}

bool ReplayNode::Send(const std::string &address, const MessageType &type,
                      std::span<const std::uint8_t> sample, const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    const std::shared_ptr<RabitMessage> message = type.CreateShared();
    return type.Deserialize(sample, *message) &&
           _session.Workspace().AddMessageToQueue(address, message, receipt);
}

std::uint64_t ReplayNode::Replaced() const
{
    std::uint64_t replaced = 0;
    for (const Gateway::PublicationStatus &status : _session.Fleet().publications)
    {
        replaced += status.replaced;
    }
    return replaced;
}

}  // namespace Rabit::Tool
