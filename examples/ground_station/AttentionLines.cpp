#include "AttentionLines.h"

#include "NodeState.h"
#include "WireNames.h"

#include <map>
#include <set>

namespace Ground
{
namespace
{
// The way in which a command failed at its aircraft; null for all other commands.
const char *HowItFailed(CommandProgress progress)
{
    switch (progress)
    {
        case CommandProgress::PROGRESS_DECLINED:
            return "is declined";
        case CommandProgress::PROGRESS_EXPIRED:
            return "was too old on the way and never arrived";
        case CommandProgress::PROGRESS_IN_DOUBT:
            return "may or may not have arrived";
        case CommandProgress::PROGRESS_REFUSED:
            return "was not sent";
        case CommandProgress::PROGRESS_SENT:
        case CommandProgress::PROGRESS_DELIVERED:
        case CommandProgress::PROGRESS_ACCEPTED:
        case CommandProgress::PROGRESS_DONE:
        case CommandProgress::PROGRESS_REPLACED:
            break;
    }
    return nullptr;
}

std::string CommandText(const CommandStatus &command)
{
    const char *const how = HowItFailed(command.progress);
    if (how == nullptr)
        return "";
    const std::string text =
        "command " + std::to_string(command.number) + " (" + WireName(command.kind) + ") " + how;
    return command.reason.empty() ? text : text + ": " + Printable(command.reason, LongestReason);
}
}  // namespace

std::vector<std::string> AttentionLines(const std::vector<FleetRow> &rows, const CommandList &commands,
                                        const CommandTally &tally, double fleetAgeS)
{
    std::map<std::string, const CommandStatus *> last;
    for (const CommandStatus &command : commands.items)
        last[command.node] = &command;
    std::set<std::string> withoutOrders;
    for (const NodeCommands &node : tally.nodes)
        if (node.without_orders)
            withoutOrders.insert(node.node);

    std::vector<std::string> lines;
    // Then the states in the rows are too old to tell anything about the aircraft.
    const bool silent = fleetAgeS > FleetFreshS;
    if (silent)
        lines.push_back("The gateway of this ground station is silent");
    for (const FleetRow &row : rows)
    {
        const auto add = [&](const std::string &text)
        {
            if (!text.empty())
                lines.push_back(Printable(row.Node, LongestName) + ": " + text);
        };
        if (!silent)
            add(WhatIsMissing(row));
        if (!row.BadPosition.empty())
            add("bad position: " + Printable(row.BadPosition, LongestReason));
        if (row.IsBatteryBelow(FleetRow::BatteryWarning))
            add("the battery is at " + std::to_string(static_cast<int>(*row.BatteryPercent)) + " %");
        if (!row.AreaDeclined.empty())
            add("the search area is declined: " + Printable(row.AreaDeclined, LongestReason));
        if (const auto command = last.find(row.Node); command != last.end())
            add(CommandText(*command->second));
        if (withoutOrders.contains(row.Node))
            add("it is back without orders");
    }
    return lines;
}

}  // namespace Ground
