#include "recording/MessageTaps.h"

#include <rabit/ManagerControlMessage.h>
#include <rabit/ManagerStatusMessage.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/gateway/SchemaText.h>
#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <utility>

#include "recording/JsonStreams.h"

namespace Rabit
{
namespace
{

const char *StateOf(ManagerStatusMessage::RunningState_e state)
{
    switch (state)
    {
        case ManagerStatusMessage::MgrState_Startup:
            return "startup";
        case ManagerStatusMessage::MgrState_Running:
            return "running";
        default:
            return "shutdown";
    }
}

bool EncodeManager(const RabitMessage &message, Mcap::Bytes &bytes)
{
    const auto *status = dynamic_cast<const ManagerStatusMessage *>(&message);
    if (status == nullptr)
    {
        return false;
    }
    nlohmann::ordered_json queues = nlohmann::ordered_json::array();
    for (const QueueStatus_t &queue : status->Queues)
    {
        queues.push_back({{"name", queue.Name},
                          {"capacity", queue.Capacity},
                          {"fill", queue.FillLevel},
                          {"refused", queue.RefusedAdds}});
    }
    const nlohmann::ordered_json json = {
        {"manager", status->ManagerName},
        {"state", StateOf(status->RunningState)},
        {"error", status->ErrorCondition},
        {"error_code", status->ErrorCode},
        {"units_of_work", status->ManagerStats.TotalNumberOfExecuteCycles},
        {"longest_unit_of_work_s", status->ManagerStats.MaxExecuteUnitOfWorkTime_Sec},
        {"missed_turns", status->ManagerStats.NumberOfMissedTurns},
        {"queues", queues}};
    const std::string text = json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    bytes.assign(text.begin(), text.end());
    return true;
}

bool EncodeByType(const MessageType &type, const RabitMessage &message, Mcap::Bytes &bytes)
{
    bytes.resize(type.SerializedSize(message));
    const std::size_t size = type.Serialize(message, bytes);
    return size != 0 && size == bytes.size();
}

}  // namespace

MessageTaps::MessageTaps(const GatewayConfig &config, RabitWorkspace &workspace,
                         std::shared_ptr<RecordingTarget> target)
    : _config(config),
      _workspace(workspace),
      _target(std::move(target)),
      _managers(_target->Inbox().AddStream(JsonStreams::Managers(config.Node)))
{
    if (!config.Record->Queues && !config.Tool)  // a tool hears none
    {
        _notRecorded["queue messages"] = "`record: queues` is off";
        _target->Inbox().SetMetadata("rabit.not_recorded", {_notRecorded.begin(), _notRecorded.end()});
    }
}

MessageTaps::~MessageTaps() = default;

void MessageTaps::Look()
{
    const std::size_t notRecorded = _notRecorded.size();
    std::erase_if(_known, [this](const auto &known) { return !_workspace.FindGlobalMessage(known.first); });
    for (const MessageInfo &message : _workspace.GetListOfMessages())
    {
        const auto global = _workspace.FindGlobalMessage(message.Name);
        Known &known = _known[message.Name];
        if (!global || known.Global == global)
        {
            continue;
        }
        known.Global = global;
        known.Tap = IsWanted(message.Name) ? Tap(message.Name, global) : nullptr;
        if (known.Tap)
        {
            known.Tap->Begin();
        }
    }
    if (_notRecorded.size() != notRecorded)
    {
        _target->Inbox().SetMetadata("rabit.not_recorded", {_notRecorded.begin(), _notRecorded.end()});
    }
}

bool MessageTaps::IsWanted(const std::string &name) const
{
    return MatchesAny(_config.Record->Messages, name) && !MatchesAny(_config.Record->Except, name) &&
           !IsTakenOver(name);
}

// ../backfill records these messages, as they come.
bool MessageTaps::IsTakenOver(const std::string &name) const
{
    const Origin origin = OriginOf(name);
    return origin.IsMirrored && _target->IsTakenOver(origin.Message);
}

void MessageTaps::AddSubscription(const SubscribeRule &rule)
{
    const std::lock_guard lock(_mutex);
    _added.push_back(rule);
}

MessageTaps::Origin MessageTaps::OriginOf(const std::string &name) const
{
    const std::size_t slash = name.find('/');
    if (slash != std::string::npos)
    {
        const std::string node = name.substr(0, slash);
        const std::string message = name.substr(slash + 1);
        const std::lock_guard lock(_mutex);
        // A program may go on adding rules to its configuration (FleetFollower).
        for (const auto *rules : {&_config.Subscribe, &_added})
        {
            const auto rule = std::find_if(rules->begin(), rules->end(),
                                           [&](const SubscribeRule &one)
                                           { return one.Message == message && MatchesAny(one.From, node); });
            if (rule != rules->end())
            {
                return {node, message, true, rule->Qos != QosProfile::Telemetry,
                        rule->Qos ? WordOf(*rule->Qos) : ""};
            }
        }
    }
    const auto rule = std::find_if(_config.Publish.begin(), _config.Publish.end(),
                                   [&name](const PublishRule &one) { return one.Message == name; });
    if (rule == _config.Publish.end())
    {
        return {_config.Node, name, false, true, "none"};
    }
    return {_config.Node, name, false, rule->Qos != QosProfile::Telemetry, WordOf(rule->Qos)};
}

std::shared_ptr<MessageTap> MessageTaps::Tap(const std::string &name,
                                             const std::shared_ptr<PublishSubscribeMessage> &global)
{
    const std::unique_ptr<RabitMessage> message = global->GetCopyOfMessage();
    if (dynamic_cast<const ManagerStatusMessage *>(message.get()) != nullptr)
    {
        return TapManager(global);
    }
    if (dynamic_cast<const ManagerControlMessage *>(message.get()) != nullptr)
    {
        return nullptr;  // of the reactor, no data
    }
    const MessageType *type = MessageTypeRegistry::Of(*message);
    if (type == nullptr)
    {
        _notRecorded[name] = "its type was not made from IDL";
        return nullptr;
    }
    const Origin origin = OriginOf(name);
    RecordingStream stream;
    stream.Topic = origin.Node + "/" + origin.Message;
    stream.SchemaName = type->Name();
    stream.SchemaText = SchemaText(type->IdlText());
    stream.IsState = origin.IsState;
    stream.Metadata = {{"rabit.kind", origin.IsMirrored ? "mirrored" : "posted"},
                       {"rabit.node", origin.Node}};
    if (!origin.Qos.empty())
    {
        stream.Metadata["rabit.qos"] = origin.Qos;
    }
    const auto &box = _config.Record->BlackBox;
    std::string event = box && MatchesAny(box->Messages, name) ? "message " + stream.Topic : "";
    const std::uint32_t number = _target->Inbox().AddStream(std::move(stream));
    return std::make_shared<MessageTap>(
        global, _target, number,
        [type](const RabitMessage &one, Mcap::Bytes &bytes) { return EncodeByType(*type, one, bytes); },
        std::move(event));
}

std::shared_ptr<MessageTap> MessageTaps::TapManager(const std::shared_ptr<PublishSubscribeMessage> &global)
{
    return std::make_shared<MessageTap>(global, _target, _managers, EncodeManager);
}

}  // namespace Rabit
