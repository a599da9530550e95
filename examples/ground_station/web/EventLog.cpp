#include "EventLog.h"

#include "AreaLines.h"
#include "WireNames.h"

#include <iterator>

namespace Ground
{
namespace
{
std::string WithReason(const std::string &text, const std::string &reason)
{
    return reason.empty() ? text : text + ": " + reason;
}

StationEvent::Weight WeightOf(RowState state)
{
    switch (state)
    {
        case RowState::Stale:
            return StationEvent::Weight::Warning;
        case RowState::Lost:
            return StationEvent::Weight::Alarm;
        case RowState::Waiting:
        case RowState::Up:
            break;
    }
    return StationEvent::Weight::Info;
}

// A search goes on until another command comes.
std::string WordOf(OrderKind kind, CommandProgress progress)
{
    return kind == OrderKind::ORDER_SEARCH && progress == CommandProgress::PROGRESS_DONE ? "begun"
                                                                                         : WireName(progress);
}

StationEvent::Weight WeightOf(CommandProgress progress)
{
    switch (progress)
    {
        case CommandProgress::PROGRESS_DECLINED:
        case CommandProgress::PROGRESS_EXPIRED:
        case CommandProgress::PROGRESS_IN_DOUBT:
        case CommandProgress::PROGRESS_REFUSED:
            return StationEvent::Weight::Warning;
        case CommandProgress::PROGRESS_SENT:
        case CommandProgress::PROGRESS_DELIVERED:
        case CommandProgress::PROGRESS_ACCEPTED:
        case CommandProgress::PROGRESS_DONE:
        case CommandProgress::PROGRESS_REPLACED:
            break;
    }
    return StationEvent::Weight::Info;
}
}  // namespace

void EventLog::Look(const StationData &now)
{
    _nowS = now.NowS;
    for (const AircraftData &aircraft : now.Aircraft)
        LookAtAircraft(aircraft);
    LookAtTargets(now);
    if (now.Commands)
        LookAtCommands(*now.Commands.Content);
    if (now.Areas && !now.Areas.Content->items.empty())
        LookAtArea(now.Areas.Content->items.back());
    LookAtProblems(now);
}

void EventLog::LookAtAircraft(const AircraftData &aircraft)
{
    Known &known = _aircraft[aircraft.Node];
    if (known.State != aircraft.State)
    {
        if (known.State || aircraft.State != RowState::Waiting)
            Add(aircraft.Replay ? Weight::Info : WeightOf(aircraft.State), aircraft.Node,
                WithReason(ToText(aircraft.State), aircraft.Reason));
        known.State = aircraft.State;
    }
    LookAtPosition(aircraft, known);
    if (aircraft.Mission && known.Mode != aircraft.Mission.Content->mode)
    {
        known.Mode = aircraft.Mission.Content->mode;
        Add(Weight::Info, aircraft.Node, WithReason(WireName(*known.Mode), aircraft.Mission.Content->text));
    }
    if (aircraft.Mission && known.AreaDeclined != aircraft.Mission.Content->area_declined)
    {
        known.AreaDeclined = aircraft.Mission.Content->area_declined;
        if (known.AreaDeclined.empty())
            Add(Weight::Info, aircraft.Node, "takes the search area");
        else
            Add(Weight::Warning, aircraft.Node, WithReason("declines the search area", known.AreaDeclined));
    }
    if (known.WithoutOrders != aircraft.WithoutOrders)
    {
        known.WithoutOrders = aircraft.WithoutOrders;
        if (known.WithoutOrders)
            Add(Weight::Warning, aircraft.Node, "is back without orders");
    }
    if (aircraft.Health && known.WantsHome != aircraft.Health.Content->wants_home)
    {
        known.WantsHome = aircraft.Health.Content->wants_home;
        if (known.WantsHome)
            known.HomeReason = aircraft.Health.Content->reason;
        Add(known.WantsHome ? Weight::Warning : Weight::Info, aircraft.Node,
            WithReason(
                known.WantsHome ? "goes home by itself" : "no longer flies home by itself; this is over",
                known.HomeReason));
    }
}

void EventLog::LookAtPosition(const AircraftData &aircraft, Known &known)
{
    if (!aircraft.BadPosition.empty())
    {
        if (!known.BadAtS)
            Add(Weight::Warning, aircraft.Node, WithReason("bad position", aircraft.BadPosition));
        known.BadAtS = _nowS;
    }
    else if (known.BadAtS && _nowS - *known.BadAtS >= PositionHoldsS)
    {
        known.BadAtS.reset();
        Add(Weight::Info, aircraft.Node, "has a good position again");
    }
}

void EventLog::LookAtArea(const AreaStatus &area)
{
    if (area.area.number != _area)
    {
        _area = area.area.number;
        _areaSinceS = _nowS;
        _areaText.clear();
        Add(Weight::Info, "", "Search area " + std::to_string(_area) + " is given to the fleet");
    }
    const bool isAwaited = CountOf(area, AreaProgress::AREA_SENT) > 0 && _nowS - _areaSinceS < AreaAnswersS;
    const std::string text = AreaText(area);
    if (area.answers.empty() || isAwaited || text == _areaText)
        return;
    _areaText = text;
    Add(IsFlownByAll(area) ? Weight::Info : Weight::Warning, "", text);
}

void EventLog::LookAtTargets(const StationData &now)
{
    for (const ListedTarget &target : TargetsOf(now))
    {
        if (!target.Found)
            continue;
        const Uav::Finding &finding = target.Found->Finding;
        const std::string name = NameOf(finding.name);
        for (const Uav::TargetName &other : target.Formerly)
            if (_targets.erase(NameOf(other)) > 0)
                Add(Weight::Info, target.Found->Aircraft, "target " + NameOf(other) + " is " + name);
        const auto known = _targets.find(name);
        if (known == _targets.end() ? _targets.size() >= MaxFollowed : known->second == finding.stage)
            continue;
        _targets[name] = finding.stage;
        std::string text = "target " + name + " " + WireName(finding.stage);
        if (!finding.validated_by.empty())
            text += " (seen by " + finding.validated_by + ")";
        Add(Weight::Info, target.Found->Aircraft, text);
    }
}

// Logs each step, even if a command went through several since the last call.
void EventLog::LookAtCommands(const CommandList &list)
{
    std::map<std::uint32_t, std::size_t> now;
    for (const CommandStatus &command : list.items)
    {
        now[command.id] = command.steps.size();
        const auto known = _commands.find(command.id);
        for (std::size_t i = known == _commands.end() ? 0 : known->second; i < command.steps.size(); ++i)
            Add(WeightOf(command.steps[i].progress), command.node,
                WithReason("command " + std::to_string(command.number) + " (" + WireName(command.kind) +
                               ") " + WordOf(command.kind, command.steps[i].progress),
                           command.steps[i].reason));
    }
    _commands = std::move(now);  // the list is bounded, and so is this
}

// The problems that begin together at one node are one event: a node that comes may have dozens. They have no
// sign, which is for what an operator has to look at: the list of problems has them.
void EventLog::LookAtProblems(const StationData &now)
{
    std::map<std::string, KnownProblem> problems;
    std::map<std::string, std::pair<std::string, std::size_t>> news;  // by node: the first text, and how many
    for (const Rabit::Gateway::Problem &problem : now.Problems)
    {
        if (problems.size() >= MaxFollowed)
            break;
        const std::string text = WithReason(problem.subject, problem.reason);
        const auto [place, isFirst] =
            problems.try_emplace(problem.node + ' ' + text, KnownProblem{_nowS, false});
        if (!isFirst)
            continue;
        KnownProblem &known = place->second;
        if (const auto before = _problems.find(place->first); before != _problems.end())
            known = before->second;
        if (known.Told || _nowS - known.SinceS < ProblemLastsS)
            continue;
        known.Told = true;
        auto &[first, count] = news[problem.node];
        first = count == 0 ? text : first;
        ++count;
    }
    for (const auto &[node, found] : news)
        Add(Weight::Info, node,
            found.second == 1 ? found.first
                              : found.first + "; and " + std::to_string(found.second - 1) + " more problems");
    _problems = std::move(problems);
}

void EventLog::Add(Weight weight, const std::string &node, const std::string &text)
{
    _events.push_back({++_number, _nowS, weight, node, text});
    if (_events.size() > MaxEvents)
        _events.pop_front();
}

}  // namespace Ground
