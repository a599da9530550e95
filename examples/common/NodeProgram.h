// What every program that is a node has: options, configuration, errors, exit codes.
#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <functional>
#include <string>

namespace CLI
{
class App;
}

namespace Common
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
// With Check also for network settings that cannot work on this host; what is only missing yet is told on
// standard error.
Rabit::GatewayConfig LoadConfig(const NodeOptions &options);

inline constexpr int ExitFailed = 1;
inline constexpr int ExitBadInput = 2;

// Parses the arguments and runs the body. Returns the exit code: the body's; ExitFailed if an exception ended
// it; ExitBadInput if an option or a file is wrong (BadInput, Rabit::ConfigError), which is told in one line
// on standard error.
int RunProgram(CLI::App &app, int argc, char **argv, const std::function<int()> &body);

}  // namespace Common
