#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <map>
#include <string>
#include <vector>

#include "KeysOptions.h"
#include "keys/KeysFinding.h"

namespace Rabit::Tool
{

// The report of `rabit keys check` on one node.
struct KeysReport
{
    std::string Node;
    std::string Folder;
    std::string Until;  // a day; empty: unknown
    std::vector<std::string> May;
    std::vector<Keys::KeysFinding> Findings;
};

// Prints it. Returns true if there is no problem.
bool Print(const KeysReport &report, bool json);

// Reads the configurations, by their nodes. Throws ConfigError.
std::map<std::string, GatewayConfig> ConfigsOf(const KeysCheckOptions &options);

// Names the nodes of these that have no folder in that of the fleet. Returns true if there are none.
bool AllHaveKeys(const std::map<std::string, GatewayConfig> &configs, const std::string &fleet);

}  // namespace Rabit::Tool
