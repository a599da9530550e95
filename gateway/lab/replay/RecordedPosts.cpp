#include "RecordedPosts.h"

#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace Rabit::WhatIf
{
namespace
{

using Replay::ReplayStream;
using Replay::Time;

// A message that was older than this when it was posted, in nanoseconds, is posted as old as this. Clocks of
// simulated nodes begin at a few of these.
constexpr Time OldestPost = 900'000'000'000;

}  // namespace

RecordedPosts::RecordedPosts(RabitWorkspace &workspace, const GatewayConfig &config) : _workspace(workspace)
{
    for (const PublishRule &rule : config.Publish)
    {
        const MessageType *type = MessageTypeRegistry::Find(rule.Type);
        Posted posted{type->CreateShared(), type};
        if (workspace.AddPublishSubscribeMessage(rule.Message, posted.Message))
        {
            _posted.emplace(rule.Message, std::move(posted));
        }
    }
}

std::optional<std::chrono::nanoseconds> RecordedPosts::Play(const Replay::ReplayItem &item,
                                                            const ReplayStream &stream,
                                                            Replay::PostTimes &times)
{
    const MessageType *type = MessageTypeRegistry::Find(stream.Type);
    if (type == nullptr || stream.What == ReplayStream::Kind::Fleet)
    {
        return std::nullopt;
    }
    if (stream.What == ReplayStream::Kind::Queue)
    {
        const std::shared_ptr<RabitMessage> message = type->CreateShared();
        if (type->Deserialize(item.Data, *message))
        {
            _workspace.AddMessageToQueue(stream.Peer + "/" + stream.Name, message);
        }
        return std::nullopt;
    }
    const auto posted = _posted.find(stream.Name);
    if (posted == _posted.end() || posted->second.Type != type ||
        !type->Deserialize(item.Data, *posted->second.Message))
    {
        return std::nullopt;
    }
    const std::chrono::nanoseconds age(static_cast<std::int64_t>(
        std::min(item.LogTime - std::min(item.LogTime, item.PublishTime), OldestPost)));
    const PostTime now = _workspace.GetClock().Now();
    const std::chrono::nanoseconds at = times.Of(item.Stream, now.Monotonic, age);
    posted->second.Message->PostMessage(
        {now.GpsTimeSeconds - std::chrono::duration<double>(now.Monotonic - at).count(), at});
    return at;
}

void QueueTaker::ExecuteUnitOfWork()
{
    std::shared_ptr<RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
    {
    }
}

}  // namespace Rabit::WhatIf
