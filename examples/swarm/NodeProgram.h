// What the programs uav and vision have in common: options, configuration, errors.
#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <functional>
#include <string>

namespace CLI
{
class App;
}

namespace Swarm
{

struct NodeOptions
{
    std::string ConfigFile;
    std::string Node{};  // empty: the file's
    int Domain = -1;     // -1: the file's
    std::string Transport{};
    bool Check = false;
};

void Describe(CLI::App &app, NodeOptions &options);
// The gateway's configuration, with the options in place of what the file says. Throws Rabit::ConfigError.
Rabit::GatewayConfig LoadConfig(const NodeOptions &options);

// The aircraft that a vision node `uav1.vision` belongs to. Throws Rabit::ConfigError if it is no such name.
std::string AircraftOf(const std::string &visionNode);
// Says in the configuration of an aircraft what one file for a fleet cannot: it takes Targets of its own
// vision node, and SearchArea of the ground station of that name.
void CompleteAircraftConfig(Rabit::GatewayConfig &config, const std::string &ground);

// Parses the arguments and runs the body. Returns the exit code: 0; 1 if it failed; 2 if an option or a file
// is wrong, which is told in one line on standard error.
int RunProgram(CLI::App &app, int argc, char **argv, const std::function<void()> &body);

}  // namespace Swarm
