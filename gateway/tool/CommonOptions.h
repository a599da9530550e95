#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/node/NodeOptions.h>

#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace Rabit::Tool
{

// Exit codes.
inline constexpr int Good = 0;
inline constexpr int ProblemFound = 1;
inline constexpr int Usage = 2;
inline constexpr int NoNetwork = 3;  // it could not be joined, or nobody was heard

// The options of every command that looks at a network.
struct CommonOptions
{
    NodeOptions Node;
    std::vector<std::string> Interfaces;
    double Wait = 0.0;  // seconds
    bool Json = false;
    bool Verbose = false;
};

// Adds --config, --node, --domain, --transport, --keys, --interface, --wait, --json and --verbose. `wait` is
// the default of --wait, in seconds.
void AddCommonOptions(CLI::App &app, CommonOptions &options, double wait);

// The configuration of this program as a tool. Throws ConfigError.
GatewayConfig ConfigOf(const CommonOptions &options);

}  // namespace Rabit::Tool
