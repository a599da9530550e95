#pragma once

#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/node/NodeOptions.h>
#include <rabit/node/RunProgram.h>

#include <functional>
#include <string>

namespace Rabit
{

// A program that is one node: its managers, and the gateway that joins them to the other nodes.
struct NodeProgram
{
    // The gateway's configuration file, unless the option --config names another.
    std::string ConfigFile;
    // Adds the program's managers to the reactor; the gateway is added after them. May complete the
    // configuration, and reads its Parameters: those of the file that it does not read are an error. Also
    // called with --check, when nothing is run: no manager should start anything before its Startup.
    std::function<void(RabitReactor &reactor, GatewayConfig &config)> AddManagers;
    // For --help, which lists the options.
    std::string Description{};
    // Adds options of the program's own (CLI11), which are parsed before AddManagers is called. May be empty.
    std::function<void(CLI::App &)> AddOptions{};
};

// main() of such a program: reads options and configuration, runs the managers and the gateway until SIGINT,
// SIGTERM or SIGHUP, and returns the exit code as RunProgram says. Nothing is thrown. The options are those
// of NodeOptions. Log lines on stderr begin with the node's name.
int RunNode(int argc, char **argv, const NodeProgram &program);

// The same for a program without options of its own.
//
//     int main(int argc, char **argv)
//     {
//         return Rabit::RunNode(argc, argv, "sensor.yaml", [](Rabit::RabitReactor &reactor)
//                               { reactor.AddManager(std::make_unique<Sensor>()); });
//     }
int RunNode(int argc, char **argv, const std::string &configFile,
            const std::function<void(RabitReactor &reactor)> &addManagers);

}  // namespace Rabit
