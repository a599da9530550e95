#include "FleetTable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace Ground
{
namespace
{
constexpr std::size_t NodeWidth = 12;
constexpr std::size_t MissionWidth = 14;

std::string Format(const char *format, double value)
{
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string Left(const std::string &text, std::size_t width)
{
    return text + std::string(width - std::min(width, text.size()), ' ');
}

std::string Right(const std::string &text, std::size_t width)
{
    return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string AgeText(const FleetRow &row)
{
    if (!row.AgeS)
        return "-";
    return Format(*row.AgeS < 9.995 ? "%.2f s" : *row.AgeS < 999.95 ? "%.1f s" : "%.0f s", *row.AgeS);
}

Emphasis EmphasisOf(const FleetRow &row)
{
    if (row.State == RowState::Lost)
        return Emphasis::Alarm;
    return row.IsFresh() ? Emphasis::None : Emphasis::Warning;
}

std::string TableRow(const FleetRow &row)
{
    const bool old = row.AgeS && !row.IsFresh();
    std::string line = Left(Printable(row.Node, NodeWidth), NodeWidth) + " " + Left(ToText(row.State), 7) +
                       (old ? "!" : " ") + Right(AgeText(row), 8) + (old ? " (" : "  ");
    if (row.AgeS)
        line += Right(Format("%.7f", row.LatitudeDeg), 11) + " " +
                Right(Format("%.7f", row.LongitudeDeg), 12) + " " + Right(Format("%.1f", row.AltitudeM), 8) +
                " " + Right(Format("%.1f", row.SpeedMps), 6);
    else
        line += Right("-", 11) + " " + Right("-", 12) + " " + Right("-", 8) + " " + Right("-", 6);
    const std::string mission = Printable(row.Mission.empty() ? "-" : row.Mission, MissionWidth);
    line += "  " + Left(mission + (old ? ")" : ""), MissionWidth + 1);
    return line + " " + Right(std::to_string(row.Sent), 5) + " " + Right(std::to_string(row.Acknowledged), 6);
}

std::string LogLine(const FleetRow &row, double elapsedS)
{
    std::string line = Right(Format("%.1f", elapsedS), 7) + " s  " + Left(Printable(row.Node, NodeWidth), 6) +
                       " " + Left(ToText(row.State), 7);
    if (row.AgeS)
    {
        const bool old = !row.IsFresh();
        line += (old ? " OLD pose (age " : " pose (age ") + AgeText(row) + ") " +
                Format("%.7f", row.LatitudeDeg) + " " + Format("%.7f", row.LongitudeDeg) + " " +
                Format("%.1f m", row.AltitudeM) + " " + Format("%.1f m/s", row.SpeedMps);
    }
    else
    {
        line += " no pose yet";
    }
    line += ", mission " + (row.Mission.empty() ? "unknown" : Printable(row.Mission, MissionWidth));
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

std::string Printable(const std::string &text, std::size_t longest)
{
    std::string printable = text.substr(0, longest);
    for (char &c : printable)
        if (c < ' ' || c > '~')
            c = '?';
    return printable;
}

std::vector<TableLine> FleetTableLines(const std::vector<FleetRow> &rows, double elapsedS)
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
    lines.push_back({Left("NODE", NodeWidth) + " " + Left("STATE", 8) + Right("POSE AGE", 8) + "  " +
                         Right("LATITUDE", 11) + " " + Right("LONGITUDE", 12) + " " + Right("ALT m", 8) +
                         " " + Right("m/s", 6) + "  " + Left("MISSION", MissionWidth + 1) + " " +
                         Right("SENT", 5) + " " + Right("ACKED", 6),
                     Emphasis::Heading});
    for (const FleetRow &row : rows)
        lines.push_back({TableRow(row), EmphasisOf(row)});
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
