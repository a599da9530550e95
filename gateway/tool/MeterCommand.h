#pragma once

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>
#include <vector>

#include "Command.h"
#include "CommonOptions.h"
#include "FleetSession.h"
#include "Meter.h"

namespace Rabit::Tool
{

// The output of a command that measures a message.
struct MeterCommand
{
    const char *Name = nullptr;
    const char *Help = nullptr;
    std::vector<std::string> Columns;  // behind NODE
    // Cells of one node, and the members of its JSON object behind `node` and `message`.
    std::function<std::vector<std::string>(const Meter &, const std::string &node, FleetSession &)> Cells;
    std::function<void(const Meter &, const std::string &node, FleetSession &, nlohmann::ordered_json &)>
        Members;
};

// Adds such a command: it listens for --for seconds, or until Ctrl-C, and then prints a line for each node.
void AddMeterCommand(CLI::App &app, Chosen &chosen, MeterCommand what);

// Returns a number for people with `digits` digits behind the point, `-` if it is not known.
std::string NumberText(double number, int digits, const char *unit = "");

}  // namespace Rabit::Tool
