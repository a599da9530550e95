#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>

namespace CLI
{
class App;
}

namespace Rabit
{

// The options that every program in the network has, and those of nodes.
struct NodeOptions
{
    std::string ConfigFile;
    std::string Node{};  // empty: the file's
    int Domain = -1;     // -1: the file's
    std::string Transport{};
    std::string Keys{};
    bool Check = false;
};

// Adds --config, --node, --domain, --transport and --keys.
void AddNetworkOptions(CLI::App &app, NodeOptions &options);
// The network settings of the file, with the options in place of what it says; without a file the defaults.
// The name is the option's alone. Throws ConfigError.
GatewayConfig LoadNetworkConfig(const NodeOptions &options);

// Adds these and --check.
void AddNodeOptions(CLI::App &app, NodeOptions &options);
// The gateway's configuration, with the options in place of what the file says. Throws ConfigError. With
// Check also for network settings that cannot work on this host; what is only missing yet is told on standard
// error.
GatewayConfig LoadNodeConfig(const NodeOptions &options);

}  // namespace Rabit
