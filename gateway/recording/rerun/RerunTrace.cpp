#include "recording/rerun/RerunTrace.h"

#include <rabit/PublishSubscribeMessage.h>
#include <rabit/base/Fnv1a.h>
#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <exception>

#include "recording/rerun/FieldDifference.h"

namespace Rabit::Rerun
{
namespace
{

using Kind = StepEvent::Kind;

std::string TitleOf(Kind what, const std::string &name, const std::string &type)
{
    return what == Kind::Posted ? "message " + name
                                : (type.empty() ? "message" : type) + " for queue " + name;
}

}  // namespace

void RerunTrace::Prepare(const ManagerStep *step, double sinceStartupS)
{
    _step = step;
    _sinceStartupS = sinceStartupS;
    for (Events *events : {&_monotonicReadings, &_gpsReadings, &_outputs, &_lists})
    {
        events->clear();
    }
    _posts.clear();
    _forQueues.clear();
    if (step == nullptr)
    {
        return;
    }
    _monotonic = step->Began;
    _gpsTime = step->BeganGpsTime;
    for (const StepEvent &event : step->Events)
    {
        switch (event.What)
        {
            case Kind::Monotonic:
                _monotonicReadings.push_back(&event);
                break;
            case Kind::GpsTime:
                _gpsReadings.push_back(&event);
                break;
            case Kind::Listed:
                _lists.push_back(&event);
                break;
            case Kind::Fetched:
                _posts[event.Name].push_back(&event);
                break;
            case Kind::Posted:
                _posts[event.Name].push_back(&event);
                _outputs.push_back(&event);
                break;
            case Kind::Taken:
                if (auto message = MessageOf(event))
                {
                    _forQueues.emplace_back(event.Name, std::move(message));
                }
                break;
            default:
                _outputs.push_back(&event);
        }
    }
    for (const auto &[name, events] : _posts)
    {
        Bring(name);
    }
    BringToQueue();
}

std::shared_ptr<RabitMessage> RerunTrace::MessageOf(const StepEvent &event)
{
    const std::string what = event.What == Kind::Taken ? "a message of queue " : "message ";
    if (event.Type.empty())
    {
        Problem(what + event.Name + " was read, and its type was not made from IDL");
        return nullptr;
    }
    const MessageType *type = MessageTypeRegistry::Find(event.Type);
    if (type == nullptr)
    {
        Problem(what + event.Name + " was read, and this program does not have its type " + event.Type);
        return nullptr;
    }
    std::shared_ptr<RabitMessage> message = type->CreateShared();
    if (!type->Deserialize(event.Sample, *message))
    {
        Problem(what + event.Name + " was read, and what was recorded of it is no " + event.Type +
                " of this program");
        return nullptr;
    }
    const PostTime time{event.GpsTime, event.Monotonic};
    if (event.What == Kind::Taken && event.WasPosted)
    {
        PublishSubscribeMessage(message->Clone()).PostMessage(message.get(), time);  // stamps it
    }
    message->SetTimeStamp(event.GpsTime);
    message->SetRedelivered(event.IsRedelivered);
    return message;
}

bool RerunTrace::Register(const std::string &name, const std::string &type)
{
    const MessageType *known = MessageTypeRegistry::Find(type);
    return known != nullptr && !name.empty() &&
           _workspace.AddPublishSubscribeMessage(name, known->CreateShared());
}

// Posts the value that the manager fetches next of that message, unless the manager posts it before. Later
// values wait.
void RerunTrace::Bring(const std::string &name)
{
    const Events &events = _posts[name];
    if (events.empty() || events.front()->What == Kind::Posted)
    {
        return;
    }
    const StepEvent &event = *events.front();
    std::uint64_t &brought = _brought[name];
    if (event.Number <= brought)
    {
        return;
    }
    brought = event.Number;
    const std::shared_ptr<RabitMessage> message = MessageOf(event);
    if (!message)
    {
        return;
    }
    if (!_workspace.FindGlobalMessage(name) && !Register(name, event.Type))
    {
        Problem("message " + name + " was read, and cannot be registered");
        return;
    }
    try
    {
        _workspace.FindGlobalMessage(name)->PostMessage(message.get(), {event.GpsTime, event.Monotonic});
    }
    catch (const std::exception &error)
    {
        Problem("message " + name + " was read, and is of another type than " + event.Type + " now");
    }
}

void RerunTrace::Passed(const std::string &name, StepEvent::Kind what)
{
    const auto found = _posts.find(name);
    if (found == _posts.end() || found->second.empty() || found->second.front()->What != what)
    {
        return;
    }
    if (what == Kind::Posted)
    {
        _brought[name] = found->second.front()->Number;
    }
    found->second.pop_front();
    Bring(name);
}

// Adds messages to the queues as far as there is room; the rest follows when the manager has taken one.
void RerunTrace::BringToQueue()
{
    while (!_forQueues.empty())
    {
        const auto &[queue, message] = _forQueues.front();
        const QueueAddResult result = _workspace.DeliverToQueue(queue, message);
        if (result == QueueAddResult::Full)
        {
            return;
        }
        if (result != QueueAddResult::Ok)
        {
            Problem("a message of queue " + queue + " was read, and there is no such queue that takes it");
        }
        _forQueues.pop_front();
    }
}

void RerunTrace::BeginStep(Step step, bool)
{
    _runs = _step != nullptr && _step->What == step;
}

void RerunTrace::EndStep(bool threw)
{
    if (std::exchange(_runs, false))
    {
        if (!_outputs.empty())
        {
            const StepEvent &event = *_outputs.front();
            Differs(TitleOf(event.What, event.Name, event.Type), "", JsonOf(event.Type, event.Sample),
                    "nothing");
        }
        if (threw != _step->Threw)
        {
            const auto word = [](bool one) { return std::string(one ? "an exception" : "no exception"); };
            Differs("the end of the step", "", word(_step->Threw), word(threw));
        }
        ++_result.Steps;
        _step = nullptr;
    }
}

const StepEvent *RerunTrace::Next(Events &events)
{
    if (events.empty())
    {
        return nullptr;
    }
    const StepEvent *const event = events.front();
    events.pop_front();
    return event;
}

// A manager that reads the clock more often than it did gets the last reading again.
void RerunTrace::ReadMonotonic(std::chrono::nanoseconds &time)
{
    if (_runs)
    {
        const StepEvent *const event = Next(_monotonicReadings);
        _monotonic = event == nullptr ? _monotonic : event->Monotonic;
        time = _monotonic;
    }
}

void RerunTrace::ReadGpsTime(double &gpsTimeSeconds)
{
    if (_runs)
    {
        const StepEvent *const event = Next(_gpsReadings);
        _gpsTime = event == nullptr ? _gpsTime : event->GpsTime;
        gpsTimeSeconds = _gpsTime;
    }
}

void RerunTrace::Fetched(const PublishSubscribeMessage &global, const RabitMessage &, std::uint64_t)
{
    if (_runs)
    {
        Passed(_names.Of(global), Kind::Fetched);
    }
}

std::optional<PostTime> RerunTrace::Posting(const PublishSubscribeMessage &global)
{
    if (!_runs || _outputs.empty() || _outputs.front()->What != Kind::Posted ||
        _outputs.front()->Name != _names.Of(global))
    {
        return std::nullopt;
    }
    return PostTime{_outputs.front()->GpsTime, _outputs.front()->Monotonic};
}

void RerunTrace::Posted(const PublishSubscribeMessage &global, const RabitMessage &message, std::uint64_t)
{
    if (_runs)
    {
        const std::string &name = _names.Of(global);
        Compare(Next(_outputs), Kind::Posted, name, message);
        Passed(name, Kind::Posted);
    }
}

void RerunTrace::Taken(const std::string &, const RabitMessage &)
{
    BringToQueue();
}

std::optional<bool> RerunTrace::Adding(const std::string &queue, const RabitMessage &message)
{
    if (!_runs)
    {
        return false;
    }
    const StepEvent *const recorded = Next(_outputs);
    Compare(recorded, Kind::Added, queue, message);
    return recorded != nullptr && recorded->What == Kind::Added;
}

// Lists the messages that were there in flight, as far as this program has their types.
void RerunTrace::Listed(std::vector<MessageInfo> &messages)
{
    if (!_runs)
    {
        return;
    }
    if (const StepEvent *const event = Next(_lists))
    {
        for (const auto &[name, type] : event->Names)
        {
            _known.insert(name);
            if (!_workspace.FindGlobalMessage(name))
            {
                Register(name, type);
            }
        }
    }
    messages.clear();
    for (const std::string &name : _known)
    {
        if (const auto global = _workspace.FindGlobalMessage(name))
        {
            messages.push_back({name, global->MsgTypeIndex(), _brought[name]});
        }
    }
}

void RerunTrace::Compare(const StepEvent *recorded, StepEvent::Kind what, const std::string &name,
                         const RabitMessage &message)
{
    const MessageType *const type = MessageTypeRegistry::Of(message);
    std::vector<std::uint8_t> sample;
    if (type != nullptr)
    {
        sample.resize(type->SerializedSize(message));
        sample.resize(type->Serialize(message, sample));
    }
    _result.Digest = Fnv1a(_result.Digest).Add(name).AddByte(0).Add(sample).Sum();
    ++_result.Outputs;
    const std::string typeName = type == nullptr ? "" : type->Name();
    const std::string title = TitleOf(what, name, typeName);
    if (recorded == nullptr)
    {
        Differs(title, "", "nothing", JsonOf(typeName, sample));
        return;
    }
    const std::string recordedTitle = TitleOf(recorded->What, recorded->Name, recorded->Type);
    if (recordedTitle != title || recorded->Type != typeName)
    {
        Differs(recordedTitle, "", JsonOf(recorded->Type, recorded->Sample), title);
    }
    else if (recorded->Sample != sample)
    {
        const FieldDifference difference = FirstDifference(typeName, recorded->Sample, sample);
        Differs(title, difference.Field, difference.Recorded, difference.Computed);
    }
}

void RerunTrace::Differs(const std::string &what, const std::string &field, const std::string &recorded,
                         const std::string &computed)
{
    if (!_result.Difference)
    {
        _result.Difference =
            RerunDifference{_step->Number, _sinceStartupS, _step->LogTime, what, field, recorded, computed};
    }
}

void RerunTrace::Problem(const std::string &text)
{
    if (_result.Problem.empty())
    {
        _result.Problem = text;
    }
}

}  // namespace Rabit::Rerun
