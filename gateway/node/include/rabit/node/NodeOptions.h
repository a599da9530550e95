#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace Rabit
{

// The options of every program that joins the network, and those of nodes.
struct NodeOptions
{
    std::string ConfigFile;
    std::string Node{};  // empty: the file's
    int Domain = -1;     // -1: the file's
    std::string Transport{};
    std::string Keys{};
    std::vector<std::string> Interfaces{};  // empty: the file's
    std::string Record{};                   // a folder; empty: the file's
    bool Check = false;
};

// Adds --config, --node, --domain, --transport and --keys.
void AddNetworkOptions(CLI::App &app, NodeOptions &options);
// Loads the network settings of the file; without a file, the defaults. Options replace them. The node's name
// comes from --node alone. Throws ConfigError.
GatewayConfig LoadNetworkConfig(const NodeOptions &options);

// Adds the network options, --interface, --record and --check.
void AddNodeOptions(CLI::App &app, NodeOptions &options);
// Loads the gateway's configuration; options replace settings of the file. Throws ConfigError. With Check, it
// also throws for network settings that cannot work on this host, and names on standard error those that are
// only missing yet.
GatewayConfig LoadNodeConfig(const NodeOptions &options);

}  // namespace Rabit
