// One aircraft: an autopilot, a mission control, a health monitor, and the gateway that joins them to the
// other nodes.
#include "AircraftConfig.h"
#include "Autopilot.h"
#include "Flight.h"
#include "HealthMonitor.h"
#include "MissionControl.h"
#include "Names.h"
#include "NodeProgram.h"
#include "NumberWithin.h"
#include "SimulatedVehicle.h"
#include "Track.h"
#include "mavlink/ByteChannel.h"
#include "mavlink/MavlinkVehicle.h"

#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

namespace
{
struct Options
{
    Common::NodeOptions Node{.ConfigFile = "uav.yaml"};
    std::string TrackFile;
    std::string Mavlink;
    std::string Ground = "ground";
    double EnduranceMinutes = 40;
};

// Circles south of the field, beside those of the other aircraft: the number at the end of the name says
// where.
Swarm::Circle PatternFor(const std::string &node)
{
    constexpr int perRow = 5;
    constexpr double apartM = 130;
    const int number = Swarm::Names::NumberOf(node);
    const Swarm::GeoPoint field{47.3977, 8.5456, 500};
    return {Swarm::Moved(field, {-310 - number / perRow * apartM, (number % perRow - 2) * apartM,
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

Swarm::HealthMonitor::Options HealthOptions(const Options &options)
{
    Swarm::HealthMonitor::Options health;
    health.Ground = options.Ground;
    if (options.Mavlink.empty())
        health.EnduranceS = options.EnduranceMinutes * 60;
    return health;
}

int Fly(const Options &options)
{
    Rabit::GatewayConfig config = Common::LoadConfig(options.Node);
    Swarm::CompleteAircraftConfig(config, options.Ground);
    const Swarm::Names names(config.Node, config.Node);
    std::unique_ptr<Swarm::Vehicle> vehicle = MakeVehicle(options, config.Node);
    if (options.Node.Check)
        return 0;
    Rabit::RabitReactor reactor;
    reactor.AddManager(std::make_unique<Swarm::Autopilot>(names, std::move(vehicle)));
    reactor.AddManager(std::make_unique<Swarm::MissionControl>(names, options.Ground));
    reactor.AddManager(std::make_unique<Swarm::HealthMonitor>(names, HealthOptions(options)));
    reactor.AddManager(
        std::make_unique<Rabit::GatewayManager>(config, Rabit::MakeTransport(config.Transport)));
    reactor.Run();  // until SIGINT or SIGTERM
    return 0;
}
}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("An aircraft of the example fleet.");
    Options options;
    Common::Describe(app, options.Node);
    app.add_option("--track", options.TrackFile, "CSV file of the track to fly (default: circles)");
    app.add_option("--mavlink", options.Mavlink,
                   "A real autopilot in place of the simulated one: `udp:PORT`, where it sends to, or "
                   "`serial:DEVICE:BAUD`");
    app.add_option("--ground", options.Ground, "Name of the ground station's node (default: ground)");
    app.add_option("--endurance", options.EnduranceMinutes,
                   "Minutes that the simulated battery lasts (default: 40)")
        ->check(Common::NumberWithin({0.1, 10'000}));
    return Common::RunProgram(app, argc, argv, [&] { return Fly(options); });
}
