#include "TestNode.h"

#include <rabit/RabitReactor.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>

#include <chrono>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>

namespace TestNode
{

namespace
{

Rabit::PathRule PathIn(const std::string &text)
{
    std::istringstream words(text);
    Rabit::PathRule path;
    std::string budget;
    std::getline(words, path.Name, ':');
    std::getline(words, path.Transport, ':');
    std::getline(words, path.Interfaces.emplace_back(), ':');
    if (std::getline(words, budget))
    {
        path.Radio.Budget = std::stod(budget);
    }
    return path;
}

}  // namespace

void DescribeNetwork(CLI::App &app, Rabit::GatewayConfig &config)
{
    app.add_option("--node", config.Node)->required();
    app.add_option("--transport", config.Transport);
    app.add_option("--domain", config.Domain);
    app.add_option("--interface", config.Interfaces);
    app.add_option("--peer", config.Peers, "Address of another node, for unicast discovery");
    app.add_flag("!--no-multicast", config.Multicast);
    app.add_option_function<std::string>(
        "--keys", [&config](const std::string &folder) { config.Security.emplace().Keys = folder; },
        "Folder of the node's keys");
    app.add_option("--budget", config.Radio.Budget, "Bytes a second that the node may put on the air");
    app.add_option("--slowest-beat", config.Radio.SlowestBeat, "Milliseconds");
    app.add_option_function<std::vector<std::string>>(
        "--path",
        [&config](const std::vector<std::string> &paths)
        {
            for (const std::string &text : paths)
            {
                config.Paths.push_back(PathIn(text));
            }
        },
        "NAME:TRANSPORT:INTERFACE[:BUDGET], the best first; in place of --interface and --budget");
    app.add_option_function<int>(
        "--lease", [&config](int seconds) { config.Lease = std::chrono::seconds(seconds); },
        "DDS lease, in seconds");
}

void Run(const Rabit::GatewayConfig &config, std::vector<std::unique_ptr<Rabit::RabitManager>> managers)
{
    Rabit::ValidateTransportName(config, Rabit::AvailableTransports(), Rabit::KnownTransports());
    Rabit::RabitReactor reactor;
    for (std::unique_ptr<Rabit::RabitManager> &manager : managers)
    {
        reactor.AddManager(std::move(manager));
    }
    reactor.AddManager(
        std::make_unique<Rabit::GatewayManager>(config, Rabit::TransportsOf(config, Rabit::MakeTransport)));
    reactor.Run();
}

int Main(CLI::App &app, int argc, char **argv, const std::function<void()> &body)
{
    try
    {
        app.parse(argc, argv);
        body();
        return 0;
    }
    catch (const CLI::ParseError &error)
    {
        return app.exit(error) == 0 ? 0 : 2;
    }
    catch (const Rabit::ConfigError &error)
    {
        std::cerr << error.what() << '\n';
        return 2;
    }
    catch (const std::exception &error)
    {
        std::cerr << argv[0] << ": " << error.what() << '\n';
        return 1;
    }
}

}  // namespace TestNode
