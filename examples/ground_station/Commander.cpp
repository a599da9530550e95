#include "Commander.h"

#include "PlanGoto.h"
#include "PositionCheck.h"

#include <rabit/RabitLog.h>
#include <rabit/gateway/GatewayManager.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace Ground
{

Commander::Commander(Settings settings, Rabit::RabitWorkspace &workspace)
    : RabitManager("Commands", workspace), _settings(std::move(settings)), _log(_settings.FirstId)
{
    AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
    AddPublishSubscribeMessage("Geofence", _fence);
    AddPublishSubscribeMessage("SearchArea", _area);
    AddPublishSubscribeMessage("CommandTally", _tally);
    AddPublishSubscribeMessage("CommandList", _list);
    AddPublishSubscribeMessage("AreaList", _areas);
    SetPeriodSec(std::chrono::duration<double>(WorkPeriod).count());
    SetWakeupBetweenTurns(true);  // answers and outcomes are handled at once
}

void Commander::Startup()
{
    _start = GetWorkspace().GetClock().Monotonic();
    *_fence = _settings.Fence;
    _fence->PostMessage();
}

void Commander::ExecuteUnitOfWork()
{
    const std::chrono::nanoseconds elapsed = GetWorkspace().GetClock().Monotonic() - _start;
    _elapsedS = std::chrono::duration<double>(elapsed).count();
    FollowReceipts();
    TakeMessages();
    LookAtAreas(elapsed);
    FollowMissionStates();
    if (IsTurn() && !IsQuiet(elapsed))
        CommandBySettings(elapsed);
    PostIfChanged();
    EndIfDone(elapsed);
}

void Commander::RequestEnd()
{
    _endRequested = true;
    WakeUpManagerEH();
}

void Commander::TakeMessages()
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
    {
        if (const auto *answer = dynamic_cast<const Uav::CommandAck *>(message.get()))
            _log.Answered(*answer, _elapsedS);
        else if (const auto *order = dynamic_cast<const Order *>(message.get()))
            Obey(*order);
        else if (const auto *area = dynamic_cast<const Uav::SearchArea *>(message.get()))
        {
            Take(*area);
            _areaIsWanted = true;
        }
    }
}

void Commander::Obey(const Order &order)
{
    _ordered.insert(order.node);
    if (const auto aircraft = _aircraft.find(order.node); aircraft != _aircraft.end())
        aircraft->second.WithoutOrders = false;
    CommandStatus command;
    command.node = order.node;
    command.kind = order.kind;
    command.latitude_deg = order.latitude_deg;
    command.longitude_deg = order.longitude_deg;
    command.altitude_m = order.altitude_m;
    if (!Send(command, order.speed_mps))
        _log.RefusedForGood(command, "it is not known, or too much waits for it already", _elapsedS);
}

void Commander::Take(Uav::SearchArea area)
{
    area.number = std::max(_area->number, _highestArea) + 1;
    _area->CopyMessage(&area);
    _area->PostMessage();
    _areaLog.Given(area, _elapsedS);
}

void Commander::LookAtAreas(std::chrono::nanoseconds elapsed)
{
    bool anyWithout = false;
    bool isAwaited = false;  // the first report of one of them
    bool isLower = false;
    for (auto &[node, aircraft] : _aircraft)
    {
        if (aircraft.IsReplay || !aircraft.First || !aircraft.State->GetGlobalPublishSubscribeMessageRef())
            continue;
        const bool isThere = _elapsedS - aircraft.HeardS <= 2 * PoseFreshS;
        aircraft.State->FetchMessage();
        isAwaited = isAwaited || (isThere && elapsed < *aircraft.First) ||
                    (isThere && !aircraft.State->WasPosted() && elapsed < *aircraft.First + ReportPatience);
        if (!aircraft.State->WasPosted())
            continue;
        _highestArea = std::max(_highestArea, aircraft.State->search_area);
        anyWithout = anyWithout || (isThere && aircraft.State->search_area == 0);
        // Once in a life, so that two ground stations do not outbid each other.
        if (std::exchange(aircraft.LifeWithArea, aircraft.Life) != aircraft.Life)
            isLower = isLower || aircraft.State->search_area > _area->number;
    }
    if (_settings.Area && _area->number == 0 && _highestArea == 0 && anyWithout && !isAwaited)
        Take(*_settings.Area);
    else if (_areaIsWanted && isLower)
        Take(Uav::SearchArea(*_area));  // one that was away has an area of an earlier run
}

// Replays are no aircraft, and report an area of the past.
void Commander::FollowMissionStates()
{
    std::vector<AreaReport> reports;
    for (auto &[node, aircraft] : _aircraft)
    {
        if (aircraft.IsReplay || !aircraft.State->GetGlobalPublishSubscribeMessageRef())
            continue;
        aircraft.State->FetchMessage();
        if (!aircraft.State->WasPosted())
            continue;
        const bool isLost = StateOf(*_fleet, 0, node) == RowState::Lost;
        const double postedS = _elapsedS - aircraft.State->GetAgeSeconds();
        reports.push_back(
            {node, isLost, aircraft.State->search_area, aircraft.State->area_declined, postedS});
        _log.Reported(node, aircraft.State->last_command, postedS, _elapsedS);
    }
    _areaLog.Look(reports);
}

bool Commander::MayLackArea(const Aircraft &aircraft, std::chrono::nanoseconds elapsed) const
{
    return _settings.Area && elapsed < *aircraft.First + ReportPatience &&
           (!aircraft.State->WasPosted() ||
            (aircraft.State->search_area == 0 && aircraft.State->area_declined.empty()));
}

void Commander::CommandBySettings(std::chrono::nanoseconds elapsed)
{
    _fleet->FetchMessage();
    for (const Rabit::Gateway::NodeStatus &status : _fleet->nodes)
        if (status.state == Rabit::Gateway::NodeState::UP)
            CommandBySettings(status, elapsed);
}

void Commander::CommandBySettings(const Rabit::Gateway::NodeStatus &status, std::chrono::nanoseconds elapsed)
{
    Aircraft &aircraft = AircraftOf(status.node);
    aircraft.IsReplay = status.replay;
    if (!aircraft.Pose->GetGlobalPublishSubscribeMessageRef())
        return;  // the name belongs to a message of another type, which the workspace has logged
    aircraft.Pose->FetchMessage();
    if (!(aircraft.Pose->GetAgeSeconds() <= PoseFreshS))
        return;  // no aircraft, or it is not UP with a fresh pose
    LookForNewLife(status.node, status.incarnation);
    if (!aircraft.First)
        aircraft.First = aircraft.NextGoto = elapsed + FirstAfter();
    if (elapsed < *aircraft.First)
        return;

    if (!_ordered.contains(status.node) &&
        (_settings.Searchers.contains(status.node) || _settings.Searchers.contains("*")) &&
        aircraft.ToldToSearch != status.incarnation && !MayLackArea(aircraft, elapsed))
    {
        CommandStatus command;
        command.node = status.node;
        command.kind = OrderKind::ORDER_SEARCH;
        if (Send(command, 0))
            aircraft.ToldToSearch = status.incarnation;
        else
            _log.Refused(status.node);  // the gateway does not know that queue yet: try again next turn
    }
    if (_settings.Period && elapsed >= *aircraft.NextGoto && SendGoto(status.node, *aircraft.Pose))
        aircraft.NextGoto = elapsed + *_settings.Period;
}

// If an aircraft restarts after a person commanded it, it has forgotten the command, and waits.
void Commander::LookForNewLife(const std::string &node, std::uint64_t life)
{
    Aircraft &aircraft = AircraftOf(node);
    const bool isBack = aircraft.Life != 0 && aircraft.Life != life;
    if (isBack)
        _log.StartedAnew(node, aircraft.HeardS, _elapsedS);
    aircraft.Life = life;
    aircraft.HeardS = _elapsedS;
    if (!isBack || !_ordered.contains(node))
        return;
    aircraft.WithoutOrders = true;
    Rabit::RabitLog::Write(Rabit::RabitLogLevel::Warning, node + " is back without orders");
}

bool Commander::SendGoto(const std::string &node, const Uav::Pose &pose)
{
    if (!WhyImpossible(pose).empty())
        return false;  // there is no place near it
    const Uav::Goto plan = PlanGoto(pose, _log.NextId());
    CommandStatus command;
    command.node = node;
    command.kind = OrderKind::ORDER_GOTO;
    command.latitude_deg = plan.latitude_deg;
    command.longitude_deg = plan.longitude_deg;
    command.altitude_m = plan.altitude_m;
    if (Send(command, plan.speed_mps))
        return true;
    _log.Refused(node);
    return false;
}

Commander::Aircraft &Commander::AircraftOf(const std::string &node)
{
    Aircraft &aircraft = _aircraft[node];
    if (!aircraft.Pose)
    {
        aircraft.Pose = std::make_shared<Uav::Pose>();
        AddPublishSubscribeMessage(node + "/Pose", aircraft.Pose);
        aircraft.State = std::make_shared<Uav::MissionState>();
        AddPublishSubscribeMessage(node + "/MissionState", aircraft.State);
    }
    return aircraft;
}

bool Commander::Send(const CommandStatus &command, float speedMps)
{
    const std::uint32_t id = _log.NextId();
    const std::string to = command.node + "/MissionControl";
    const std::string replyTo = _settings.Node + "/Commands";
    auto receipt = std::make_shared<Rabit::RabitQueueReceipt>();
    WakeUpManagerOnOutcome(receipt);

    const auto send = [&](auto message)
    {
        message->id = id;
        message->reply_to = replyTo;
        return AddMessageToQueue(to, message, receipt);
    };
    bool sent = false;
    switch (command.kind)
    {
        case OrderKind::ORDER_GOTO:
        {
            auto message = std::make_shared<Uav::Goto>();
            message->latitude_deg = command.latitude_deg;
            message->longitude_deg = command.longitude_deg;
            message->altitude_m = command.altitude_m;
            message->speed_mps = speedMps;
            sent = send(message);
            break;
        }
        case OrderKind::ORDER_HOME:
        {
            auto message = std::make_shared<Uav::GoHome>();
            message->reason = "called by " + _settings.Node;
            sent = send(message);
            break;
        }
        case OrderKind::ORDER_SEARCH:
            sent = send(std::make_shared<Uav::Search>());
            break;
    }
    if (!sent)
        return false;
    _log.Sent(command, _elapsedS);
    _onWay[id] = std::move(receipt);
    return true;
}

void Commander::FollowReceipts()
{
    for (auto entry = _onWay.begin(); entry != _onWay.end();)
    {
        const Rabit::QueueOutcome outcome = entry->second->Outcome();
        _log.OnWay(entry->first, outcome, _elapsedS);
        entry = outcome == Rabit::QueueOutcome::Pending ? std::next(entry) : _onWay.erase(entry);
    }
}

void Commander::PostTallyIfChanged()
{
    CommandTally tally;
    tally.first_id = _log.FirstId();
    tally.commands = static_cast<std::uint32_t>(_log.Commands().size());
    for (const auto &[node, aircraft] : _aircraft)
    {
        const CommandLog::Tally ofNode = _log.Of(node);
        NodeCommands commands;
        commands.node = node;
        commands.sent = ofNode.Sent;
        commands.acknowledged = ofNode.Acknowledged;
        commands.without_orders = aircraft.WithoutOrders;
        tally.nodes.push_back(commands);
    }
    if (tally == *_tally)
        return;
    _tally->CopyMessage(&tally);
    _tally->PostMessage();
}

void Commander::PostAreasIfChanged()
{
    if (_areaLog.Areas() == _areas->items)
        return;
    _areas->posted_s = _elapsedS;
    _areas->items = _areaLog.Areas();
    _areas->PostMessage();
}

void Commander::PostIfChanged()
{
    PostTallyIfChanged();
    PostAreasIfChanged();

    const std::vector<CommandStatus> &all = _log.Commands();
    const std::size_t listed = std::min(all.size(), MaxListed);
    std::vector<CommandStatus> newest(all.end() - static_cast<std::ptrdiff_t>(listed), all.end());
    if (newest != _list->items)
    {
        _list->items = std::move(newest);
        _list->PostMessage();
    }
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
