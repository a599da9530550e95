#include "recording/StepRecorder.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <utility>

#include "recording/JsonStreams.h"
#include "recording/rerun/StepText.h"

namespace Rabit
{

using Rerun::StepEvent;

StepRecorder::StepRecorder(const std::string &manager, const RabitWorkspace &workspace,
                           std::shared_ptr<RecordingTarget> target)
    : _workspace(workspace),
      _target(std::move(target)),
      _stream(_target->Inbox().AddStream(JsonStreams::Steps(_target->Node(), manager))),
      _names(workspace)
{
}

void StepRecorder::BeginStep(Step step, bool isTurn)
{
    const PostTime now = _workspace.GetClock().Now();
    _step.What = step;
    _step.Number = _next++;
    _step.IsTurn = isTurn;
    _step.Began = now.Monotonic;
    _step.BeganGpsTime = now.GpsTimeSeconds;
    _step.Events.clear();
}

void StepRecorder::EndStep(bool threw)
{
    _step.Threw = threw;
    const std::string text = Rerun::TextOf(_step);
    _target->Put(_stream, _target->At(_step.Began), {text.begin(), text.end()},
                 static_cast<std::uint32_t>(_step.Number));
}

void StepRecorder::ReadMonotonic(std::chrono::nanoseconds &time)
{
    Add(StepEvent::Kind::Monotonic).Monotonic = time;
}

void StepRecorder::ReadGpsTime(double &gpsTimeSeconds)
{
    Add(StepEvent::Kind::GpsTime).GpsTime = gpsTimeSeconds;
}

void StepRecorder::Fetched(const PublishSubscribeMessage &global, const RabitMessage &message,
                           std::uint64_t number)
{
    const std::string &name = _names.Of(global);
    std::uint64_t &last = _fetched[name];
    const bool isNew = number > last;
    last = std::max(last, number);
    Add(StepEvent::Kind::Fetched, name, message, isNew).Number = number;
}

void StepRecorder::Posted(const PublishSubscribeMessage &global, const RabitMessage &message,
                          std::uint64_t number)
{
    Add(StepEvent::Kind::Posted, _names.Of(global), message, true).Number = number;
}

void StepRecorder::Taken(const std::string &queue, const RabitMessage &message)
{
    Add(StepEvent::Kind::Taken, queue, message, true);
}

// Encodes the message before it is added: the receiver may change it.
std::optional<bool> StepRecorder::Adding(const std::string &queue, const RabitMessage &message)
{
    Add(StepEvent::Kind::Refused, queue, message, true);
    return std::nullopt;
}

void StepRecorder::Added(bool accepted)
{
    if (accepted)
    {
        _step.Events.back().What = StepEvent::Kind::Added;
    }
}

void StepRecorder::Listed(std::vector<MessageInfo> &messages)
{
    StepEvent &event = Add(StepEvent::Kind::Listed);
    for (const MessageInfo &message : messages)
    {
        if (_listed.insert(message.Name).second)
        {
            const auto global = _workspace.FindGlobalMessage(message.Name);
            const auto copy = global ? global->GetCopyOfMessage() : nullptr;
            const MessageType *type = copy ? MessageTypeRegistry::Of(*copy) : nullptr;
            event.Names.emplace_back(message.Name, type == nullptr ? "" : type->Name());
        }
    }
}

StepEvent &StepRecorder::Add(StepEvent::Kind what)
{
    return _step.Events.emplace_back(StepEvent{.What = what});
}

StepEvent &StepRecorder::Add(StepEvent::Kind what, const std::string &name, const RabitMessage &message,
                             bool withSample)
{
    StepEvent &event = Add(what);
    event.Name = name;
    const PostTime time = message.GetPostTime();
    event.GpsTime = time.GpsTimeSeconds;
    event.Monotonic = time.Monotonic;
    event.WasPosted = message.WasPosted();
    event.IsRedelivered = message.IsRedelivered();
    if (const MessageType *type = MessageTypeRegistry::Of(message))
    {
        event.Type = type->Name();
        if (withSample)
        {
            event.Sample.resize(type->SerializedSize(message));
            event.Sample.resize(type->Serialize(message, event.Sample));
        }
    }
    return event;
}

}  // namespace Rabit
