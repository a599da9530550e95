#pragma once

#include <rabit/gateway/Fleet.h>

#include <optional>
#include <string>

namespace Rabit::Tool
{

// Reads what a node reports of its traffic (FleetExplorer::Report::Air). Empty if it makes no sense.
std::optional<Gateway::AirStatus> AirStatusOf(const std::string &report);

}  // namespace Rabit::Tool
