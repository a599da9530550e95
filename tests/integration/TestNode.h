// The code that test nodes in processes of their own share.
#pragma once

#include <rabit/RabitManager.h>
#include <rabit/gateway/GatewayConfig.h>

#include <functional>
#include <memory>
#include <vector>

namespace CLI
{
class App;
}

namespace TestNode
{

// Adds the options for the node's name and its network.
void DescribeNetwork(CLI::App &app, Rabit::GatewayConfig &config);

// Runs the managers and a gateway until SIGINT or SIGTERM, over the backends that the configuration names.
// Throws Rabit::ConfigError.
void Run(const Rabit::GatewayConfig &config, std::vector<std::unique_ptr<Rabit::RabitManager>> managers);

// Parses the arguments and runs the body. Returns the exit code: 0; 1 if the body failed; 2 if an option is
// wrong.
int Main(CLI::App &app, int argc, char **argv, const std::function<void()> &body);

}  // namespace TestNode
