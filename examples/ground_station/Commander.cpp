#include "Commander.h"

#include "PlanGoto.h"

#include <rabit/gateway/GatewayManager.h>

#include <algorithm>
#include <utility>

namespace Ground
{

Commander::Commander(Settings settings, Rabit::RabitWorkspace &workspace)
    : RabitManager("Commands", workspace), _settings(std::move(settings))
{
    AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
    AddPublishSubscribeMessage("CommandTally", _tally);
    SetWakeupTimeDelayMSec(static_cast<int>(WorkPeriod.count()));
}

void Commander::Startup()
{
    _start = GetWorkspace().GetClock().Monotonic();
}

void Commander::ExecuteUnitOfWork()
{
    const std::chrono::nanoseconds elapsed = GetWorkspace().GetClock().Monotonic() - _start;
    _elapsedS = std::chrono::duration<double>(elapsed).count();
    TakeAnswers();
    if (!IsQuiet(elapsed))
        SendCommands(elapsed);
    PostTally();
    EndIfDone(elapsed);
}

void Commander::RequestEnd()
{
    _endRequested = true;
    WakeUpManagerEH();
}

void Commander::TakeAnswers()
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
        if (const auto *answer = dynamic_cast<const Uav::CommandAck *>(message.get()))
            _log.Acknowledged(answer->id, answer->node, answer->stage != Uav::CommandStage::COMMAND_DECLINED);
}

void Commander::SendCommands(std::chrono::nanoseconds elapsed)
{
    _fleet->FetchMessage();
    for (const auto &status : _fleet->nodes)
    {
        if (status.state != Rabit::Gateway::NodeState::UP)
            continue;
        Target &target = TargetOf(status.node);
        if (!target.Pose->GetGlobalPublishSubscribeMessageRef())
            continue;  // the name belongs to a message of another type, which the workspace has logged
        target.Pose->FetchMessage();
        if (!(target.Pose->GetAgeSeconds() <= PoseFreshS))
            continue;  // no aircraft, or one that is not heard well
        if (!target.Next)
            target.Next = elapsed + FirstAfter();
        if (elapsed >= *target.Next && Send(status.node, *target.Pose))
            target.Next = elapsed + _settings.Period;
    }
}

Commander::Target &Commander::TargetOf(const std::string &node)
{
    Target &target = _targets[node];
    if (!target.Pose)
    {
        target.Pose = std::make_shared<Uav::Pose>();
        AddPublishSubscribeMessage(node + "/Pose", target.Pose);
    }
    return target;
}

// Returns false if nothing was sent.
bool Commander::Send(const std::string &node, const Uav::Pose &pose)
{
    auto command = std::make_shared<Uav::Goto>(PlanGoto(pose, _log.NextId()));
    command->reply_to = _settings.Node + "/Commands";
    if (!AddMessageToQueue(node + "/MissionControl", command))
    {
        _log.Refused(
            node);  // the gateway does not know that queue yet, or too much waits for it: try again soon
        return false;
    }
    _log.Sent(node, _elapsedS);
    return true;
}

void Commander::PostTally()
{
    std::vector<NodeCommands> nodes;
    for (const auto &[node, target] : _targets)
    {
        const CommandLog::Tally tally = _log.Of(node);
        NodeCommands commands;
        commands.node = node;
        commands.sent = tally.Sent;
        commands.acknowledged = tally.Acknowledged;
        nodes.push_back(commands);
    }
    if (nodes == _tally->nodes)
        return;
    _tally->nodes = std::move(nodes);
    _tally->PostMessage();
}

bool Commander::IsQuiet(std::chrono::nanoseconds elapsed) const
{
    if (_endRequested)
        return true;
    if (!_settings.Duration)
        return false;
    return elapsed >= *_settings.Duration - std::min(_settings.Quiet, *_settings.Duration / 2);
}

std::chrono::nanoseconds Commander::FirstAfter() const
{
    return _settings.Duration ? std::min(_settings.FirstAfter, *_settings.Duration / 8)
                              : _settings.FirstAfter;
}

void Commander::EndIfDone(std::chrono::nanoseconds elapsed)
{
    const bool over = _endRequested || (_settings.Duration && elapsed >= *_settings.Duration);
    if (!over)
        return;
    if (!_waitingSince)
        _waitingSince = elapsed;
    if (_log.Outstanding().empty() || elapsed - *_waitingSince >= _settings.Quiet)
        ShutdownAllManagers(true);
}

}  // namespace Ground
