#include "FleetTable.h"

#include "NumberText.h"
#include "PathText.h"

#include <algorithm>
#include <utility>

namespace Ground
{
namespace
{
// With these widths and names of up to 8 letters the table fits a terminal of 80 columns.
constexpr std::size_t NodeWidth = 8;
constexpr std::size_t MaxNodeWidth = 24;
constexpr std::size_t MissionWidth = 10;

std::string Left(const std::string &text, std::size_t width)
{
    return text + std::string(width - std::min(width, text.size()), ' ');
}

std::string Right(const std::string &text, std::size_t width)
{
    return std::string(width - std::min(width, text.size()), ' ') + text;
}

int Urgency(const FleetRow &row)
{
    switch (row.State)
    {
        case RowState::Lost:
            return 0;
        case RowState::Stale:
            return 1;
        case RowState::Waiting:
            return 4;
        case RowState::Up:
            break;
    }
    return row.IsBatteryBelow(FleetRow::BatteryAlarm)                                 ? 2
           : row.IsBatteryBelow(FleetRow::BatteryWarning) || !row.BadPosition.empty() ? 3
                                                                                      : 5;
}

// The most urgent first, so that a small screen cuts off aircraft without problems.
std::vector<FleetRow> MostUrgentFirst(std::vector<FleetRow> rows)
{
    std::stable_sort(rows.begin(), rows.end(),
                     [](const FleetRow &a, const FleetRow &b) { return Urgency(a) < Urgency(b); });
    return rows;
}

std::string AgeText(const FleetRow &row)
{
    if (!row.AgeS)
        return "-";
    return Format(*row.AgeS < 9.995 ? "%.2f" : *row.AgeS < 999.95 ? "%.1f" : "%.0f", *row.AgeS);
}

Emphasis EmphasisOf(const FleetRow &row)
{
    if (row.State == RowState::Lost || row.IsBatteryBelow(FleetRow::BatteryAlarm))
        return Emphasis::Alarm;
    return row.IsFresh() && row.BadPosition.empty() && !row.IsBatteryBelow(FleetRow::BatteryWarning)
               ? Emphasis::None
               : Emphasis::Warning;
}

std::string TableHeading(std::size_t nodeWidth)
{
    return Left("NODE", nodeWidth) + " " + Left("STATE", 8) + "AGE s" + "  " + Right("LATITUDE", 9) + " " +
           Right("LONGITUDE", 10) + " " + Right("ALT m", 6) + " " + Right("m/s", 5) + " " +
           Left("MISSION", MissionWidth + 1) + " SENT ACKED";
}

std::string TableRow(const FleetRow &row, std::size_t nodeWidth)
{
    const bool old = row.AgeS && !row.IsFresh();
    std::string line = Left(Printable(row.Node, nodeWidth), nodeWidth) + " " + Left(ToText(row.State), 7) +
                       (old ? "!" : " ") + Right(AgeText(row), 5) + (old ? " (" : "  ");
    if (row.AgeS && !row.BadPosition.empty())
        line += Right("bad position", 20) + " " + Right("-", 6) + " " + Right("-", 5);
    else if (row.AgeS)
        line += Right(Format("%.5f", row.LatitudeDeg), 9) + " " +
                Right(Format("%.5f", row.LongitudeDeg), 10) + " " + Right(Format("%.1f", row.AltitudeM), 6) +
                " " + Right(Format("%.1f", row.SpeedMps), 5);
    else
        line += Right("-", 9) + " " + Right("-", 10) + " " + Right("-", 6) + " " + Right("-", 5);
    const std::string mission = Printable(row.Mission.empty() ? "-" : row.Mission, MissionWidth);
    line += ' ';
    line += Left(mission + (old ? ")" : ""), MissionWidth + 1);
    return line + " " + Right(std::to_string(row.Sent), 4) + " " + Right(std::to_string(row.Acknowledged), 5);
}

std::string LogLine(const FleetRow &row, double elapsedS)
{
    std::string line = Right(Format("%.1f", elapsedS), 7) + " s  " +
                       Left(Printable(row.Node, MaxNodeWidth), 6) + " " + Left(ToText(row.State), 7);
    if (row.AgeS)
    {
        const bool old = !row.IsFresh();
        line += (old ? " OLD pose (age " : " pose (age ") + AgeText(row) + " s) ";
        line += row.BadPosition.empty()
                    ? Format("%.7f", row.LatitudeDeg) + " " + Format("%.7f", row.LongitudeDeg) + " " +
                          Format("%.1f m", row.AltitudeM) + " " + Format("%.1f m/s", row.SpeedMps)
                    : "bad position";
    }
    else
    {
        line += " no pose yet";
    }
    line += ", mission " + (row.Mission.empty() ? "unknown" : Printable(row.Mission, MissionWidth));
    line += row.BatteryPercent ? ", battery " + Format("%.0f %%", *row.BatteryPercent) : "";
    const std::string path = PathLogText(row);
    line += path.empty() ? "" : ", " + path;
    return line + ", commands " + std::to_string(row.Sent) + " sent " + std::to_string(row.Acknowledged) +
           " acknowledged";
}
}  // namespace

std::string ToText(RowState state)
{
    switch (state)
    {
        case RowState::Waiting:
            return "WAITING";
        case RowState::Up:
            return "UP";
        case RowState::Stale:
            return "STALE";
        case RowState::Lost:
            return "LOST";
    }
    return "?";
}

std::string WhatIsMissing(const FleetRow &row)
{
    if (row.State == RowState::Waiting || !row.AgeS)
        return "";
    const bool beats = row.State == RowState::Up;
    const bool poses = *row.AgeS <= FleetRow::FreshS;
    if (beats == poses)
        return "";
    return beats ? "no position comes" : "only its positions come";
}

std::string Printable(const std::string &text, std::size_t longest)
{
    std::string printable = text.substr(0, longest);
    for (char &c : printable)
        if (c < ' ' || c > '~')
            c = '?';
    return printable;
}

std::vector<TableLine> FleetTableLines(const std::vector<FleetRow> &rows, double elapsedS,
                                       std::size_t columns)
{
    const auto count = [&rows](RowState state)
    {
        return std::to_string(std::count_if(rows.begin(), rows.end(),
                                            [state](const FleetRow &row) { return row.State == state; }));
    };
    std::vector<TableLine> lines;
    lines.push_back({"Fleet after " + Format("%.0f s", elapsedS) + ": " + count(RowState::Up) + " UP, " +
                     count(RowState::Stale) + " STALE, " + count(RowState::Lost) + " LOST, " +
                     count(RowState::Waiting) + " WAITING"});
    std::size_t nodeWidth = NodeWidth;
    for (const FleetRow &row : rows)
        nodeWidth = std::clamp(row.Node.size(), nodeWidth, MaxNodeWidth);
    const std::string heading = TableHeading(nodeWidth);
    const bool wide = heading.size() + PathColumnsWidth <= columns;
    lines.push_back({heading + (wide ? PathHeading() : ""), Emphasis::Heading});
    for (const FleetRow &row : MostUrgentFirst(rows))
        lines.push_back({TableRow(row, nodeWidth) + (wide ? PathColumns(row) : ""), EmphasisOf(row)});
    if (!wide)
        for (std::string &line : PathLines(rows, columns))
            lines.push_back({std::move(line)});
    return lines;
}

std::vector<std::string> FleetLogLines(const std::vector<FleetRow> &rows, double elapsedS)
{
    std::vector<std::string> lines;
    for (const FleetRow &row : rows)
        lines.push_back(LogLine(row, elapsedS));
    return lines;
}

}  // namespace Ground
