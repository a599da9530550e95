#include "FleetView.h"

#include "AreaLines.h"
#include "AttentionLines.h"
#include "ProblemLines.h"
#include "RadioLines.h"
#include "ReplayLine.h"

#include <rabit/gateway/GatewayManager.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <utility>

namespace Ground
{
namespace
{
TerminalScreen::Size TerminalSize()
{
    TerminalScreen::Size size;
    winsize window{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0 && window.ws_row > 0)
    {
        size.Columns = window.ws_col;
        size.Rows = window.ws_row;
    }
    return size;
}
}  // namespace

FleetView::FleetView(const Settings &settings, Output output, Rabit::RabitWorkspace &workspace)
    : RabitManager("FleetView", workspace), _output(output), _radio(settings.MaxRates)
{
    AddPublishSubscribeMessage(Rabit::FleetMessageName, _fleet);
    AddPublishSubscribeMessage("CommandTally", _tally);
    AddPublishSubscribeMessage("CommandList", _commands);
    AddPublishSubscribeMessage("AreaList", _areas);
    for (const std::string &node : settings.Expected)
        _aircraft[node] = {std::make_unique<AircraftMonitor>(node, workspace), true};
    SetWakeupTimeDelayMSec(static_cast<int>((_output.IsTerminal ? ScreenPeriod : LogPeriod).count()));
}

void FleetView::Startup()
{
    _start = GetWorkspace().GetClock().Monotonic();
}

void FleetView::ExecuteUnitOfWork()
{
    Look();
    Print();
}

void FleetView::Look()
{
    _fleet->FetchMessage();
    _tally->FetchMessage();
    _commands->FetchMessage();
    _areas->FetchMessage();
    if (_fleet->WasPosted())
        _radio.Look(*_fleet, _fleet->GetPostTime().Monotonic);
    FollowNewNodes();
    _seen.clear();
    std::vector<SaidOfTargets> said;
    for (auto &[node, aircraft] : _aircraft)
    {
        Seen seen;
        seen.Row.Node = node;
        seen.Row.State = StateOf(*_fleet, _fleet->GetAgeSeconds(), node);
        if (const auto *const status = StatusOf(*_fleet, node))
        {
            seen.Row.RoundTripS = status->round_trip_s;
            seen.Row.DeliveryRate = status->delivery_rate;
        }
        aircraft.Monitor->Show(seen.Row, *_tally);
        if (!aircraft.Expected && !seen.Row.AgeS && seen.Row.Mission.empty())
            continue;  // not known to be an aircraft
        for (const NodeCommands &commands : _tally->nodes)
        {
            if (commands.node != node)
                continue;
            seen.Row.Sent = commands.sent;
            seen.Row.Acknowledged = commands.acknowledged;
        }
        const PoseCount count = aircraft.Monitor->Count();
        seen.Published = count.Published();
        seen.Heard = count.Heard();
        said.push_back(aircraft.Monitor->Targets());
        _seen.push_back(std::move(seen));
    }
    for (ListedTarget &target : ListTargets(said))
        for (Seen &seen : _seen)
            if (target.Found && target.Found->Aircraft == seen.Row.Node)
                seen.Targets.push_back(std::move(*target.Found));
}

void FleetView::FollowNewNodes()
{
    for (const auto &status : _fleet->nodes)
        if (!_aircraft.contains(status.node))
            _aircraft[status.node] = {std::make_unique<AircraftMonitor>(status.node, GetWorkspace()), false};
}

void FleetView::Print()
{
    std::vector<FleetRow> rows;
    for (const Seen &seen : _seen)
        rows.push_back(seen.Row);
    const double elapsedS =
        std::chrono::duration<double>(GetWorkspace().GetClock().Monotonic() - _start).count();
    if (_output.IsTerminal)
        PrintTable(rows, elapsedS);
    else
        PrintLog(rows, elapsedS);
    _output.Stream.flush();
}

void FleetView::PrintTable(const std::vector<FleetRow> &rows, double elapsedS)
{
    const TerminalScreen::Size size = TerminalSize();
    std::vector<TableLine> lines = FleetTableLines(rows, elapsedS, size.Columns);
    if (std::string replay = ReplayLine(*_fleet); !replay.empty())
        lines.insert(lines.begin(), {std::move(replay), Emphasis::Warning});
    for (TableLine &line : AreaTableLines(*_areas))
        lines.push_back(std::move(line));
    for (const std::string &line : Attention(rows))
        lines.push_back({line, Emphasis::Warning});
    for (TableLine &line : RadioTableLines(_radio.Use(), _fleet->GetAgeSeconds(), size.Columns))
        lines.push_back(std::move(line));
    for (const Seen &seen : _seen)
        for (const FoundTarget &target : seen.Targets)
            lines.push_back({TargetLine(target)});
    for (TableLine &line : ProblemTableLines(AllProblems(*_fleet), _fleet->GetAgeSeconds()))
        lines.push_back(std::move(line));
    std::vector<std::string> above;
    if (_output.TakeLog)
        above = _output.TakeLog();
    _output.Stream << _screen.Redraw(lines, size, above);
}

void FleetView::PrintLog(const std::vector<FleetRow> &rows, double elapsedS)
{
    if (const std::string replay = ReplayLine(*_fleet); !replay.empty())
        _output.Stream << "         " << replay << '\n';
    for (const std::string &line : FleetLogLines(rows, elapsedS))
        _output.Stream << line << '\n';
    if (const std::string line = NewAreaLine(); !line.empty())
        _output.Stream << "         " << line << '\n';
    for (const std::string &line : NewAttention(rows))
        _output.Stream << "         " << line << '\n';
    for (const std::string &line : TargetLinesThatChanged())
        _output.Stream << line << '\n';
    const std::string radio = RadioLogLine(_radio.Use(), _fleet->GetAgeSeconds(), elapsedS);
    if (!radio.empty())
        _output.Stream << radio << '\n';
    const std::string problems = ProblemLogLine(AllProblems(*_fleet), _fleet->GetAgeSeconds(), elapsedS);
    if (!problems.empty())
        _output.Stream << problems << '\n';
}

std::vector<std::string> FleetView::Attention(const std::vector<FleetRow> &rows) const
{
    return AttentionLines(rows, *_commands, *_tally, _fleet->WasPosted() ? _fleet->GetAgeSeconds() : 0);
}

// The line about the wanted search area if it has changed, otherwise empty.
std::string FleetView::NewAreaLine()
{
    const std::vector<TableLine> lines = AreaTableLines(*_areas);
    const std::string now = lines.empty() ? "" : lines.front().Text;
    return std::exchange(_shownArea, now) == now ? "" : now;
}

// The attention lines that the previous log line did not have.
std::vector<std::string> FleetView::NewAttention(const std::vector<FleetRow> &rows)
{
    const std::vector<std::string> now = Attention(rows);
    std::vector<std::string> lines;
    for (const std::string &line : now)
        if (!_shownAttention.contains(line))
            lines.push_back(line);
    _shownAttention = {now.begin(), now.end()};
    return lines;
}

std::vector<std::string> FleetView::TargetLinesThatChanged()
{
    std::vector<std::string> lines;
    for (const Seen &seen : _seen)
    {
        for (const FoundTarget &target : seen.Targets)
        {
            const Shown now{target.Finding.stage, target.Formerly.size()};
            const auto [shown, isNew] = _shownTargets.try_emplace(NameOf(target), now);
            if (!isNew && shown->second == now)
                continue;
            shown->second = now;
            lines.push_back("         " + TargetLine(target));
        }
    }
    return lines;
}

}  // namespace Ground
