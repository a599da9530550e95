// One simulated aircraft: an autopilot, a mission control, and the gateway that joins them to the other
// nodes.
#include "Autopilot.h"
#include "Flight.h"
#include "MissionControl.h"
#include "SimulatedVehicle.h"
#include "Track.h"
#include "mavlink/ByteChannel.h"
#include "mavlink/MavlinkVehicle.h"

#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

namespace
{
constexpr int ExitFailed = 1;
constexpr int ExitBadInput = 2;

struct Options
{
    std::string ConfigFile = "uav.yaml";
    std::string Node;
    int Domain = -1;
    std::string Transport;
    std::string TrackFile;
    std::string Mavlink;
    bool Check = false;
};

void Describe(CLI::App &app, Options &options)
{
    app.add_option("--config", options.ConfigFile, "The gateway's configuration file (default: uav.yaml)");
    app.add_option("--node", options.Node, "Name of this aircraft, in place of the file's");
    app.add_option("--domain", options.Domain, "DDS domain, in place of the file's")
        ->check(CLI::Range(0, 232));
    app.add_option("--transport", options.Transport, "DDS implementation, in place of the file's");
    app.add_option("--track", options.TrackFile, "CSV file of the track to fly (default: circles)");
    app.add_option("--mavlink", options.Mavlink,
                   "A real autopilot in place of the simulated one: `udp:PORT`, where it sends to, or "
                   "`serial:DEVICE:BAUD`");
    app.add_flag("--check", options.Check, "Check the options and files, start nothing");
}

Rabit::GatewayConfig LoadConfig(const Options &options)
{
    Rabit::GatewayConfig config = Rabit::LoadGatewayConfig(options.ConfigFile, options.Node);
    if (options.Domain >= 0)
        config.Domain = options.Domain;
    if (!options.Transport.empty())
        config.Transport = options.Transport;
    Rabit::ValidateTransportName(config, Rabit::AvailableTransports(), Rabit::KnownTransports());
    return config;
}

// Circles south of the field, beside those of the other aircraft: the number at the end of the name says
// where.
Swarm::Circle PatternFor(const std::string &node)
{
    constexpr int perRow = 5;
    constexpr double apartM = 130;
    const auto digits =
        std::find_if(node.rbegin(), node.rend(), [](unsigned char c) { return !std::isdigit(c); });
    const int number = std::atoi(std::string(digits.base(), node.end()).c_str()) % 1000;
    const Swarm::GeoPoint field{47.3977, 8.5456, 500};
    return {Swarm::Moved(field, {-280 - number / perRow * apartM, (number % perRow - 2) * apartM,
                                 number % perRow * 5.0}),
            60, 12};
}

std::unique_ptr<Swarm::Vehicle> MakeVehicle(const Options &options, const std::string &node)
{
    if (!options.Mavlink.empty())
        return std::make_unique<Swarm::MavlinkVehicle>(Swarm::OpenByteChannel(options.Mavlink));
    return std::make_unique<Swarm::SimulatedVehicle>(
        options.TrackFile.empty() ? Swarm::Flight(PatternFor(node))
                                  : Swarm::Flight(Swarm::Track::Load(options.TrackFile)));
}

void Fly(const Options &options)
{
    const Rabit::GatewayConfig config = LoadConfig(options);
    std::unique_ptr<Swarm::Vehicle> vehicle = MakeVehicle(options, config.Node);
    if (options.Check)
        return;
    const Swarm::Names names(config.Node, config.Node);
    Rabit::RabitReactor reactor;
    reactor.AddManager(std::make_unique<Swarm::Autopilot>(names, std::move(vehicle)));
    reactor.AddManager(std::make_unique<Swarm::MissionControl>(config.Node));
    reactor.AddManager(
        std::make_unique<Rabit::GatewayManager>(config, Rabit::MakeTransport(config.Transport)));
    reactor.Run();  // until SIGINT or SIGTERM
}
}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("A simulated aircraft of the example fleet.");
    Options options;
    Describe(app, options);
    try
    {
        app.parse(argc, argv);
        Fly(options);
        return 0;
    }
    catch (const CLI::ParseError &error)
    {
        return app.exit(error) == 0 ? 0 : ExitBadInput;
    }
    catch (const Rabit::ConfigError &error)
    {
        std::cerr << error.what() << '\n';
        return ExitBadInput;
    }
    catch (const Swarm::ChannelError &error)
    {
        std::cerr << error.what() << '\n';
        return ExitBadInput;
    }
    catch (const Swarm::TrackError &error)
    {
        std::cerr << error.what() << '\n';
        return ExitBadInput;
    }
    catch (const std::exception &error)
    {
        std::cerr << "uav: " << error.what() << '\n';
        return ExitFailed;
    }
}
