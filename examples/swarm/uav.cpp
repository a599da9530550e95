// One aircraft: an autopilot, a mission control, a health monitor, and the gateway that joins them to the
// other nodes.
#include "AircraftConfig.h"
#include "AircraftOptions.h"
#include "Autopilot.h"
#include "Flight.h"
#include "HealthMonitor.h"
#include "MissionControl.h"
#include "Names.h"
#include "SimulatedVehicle.h"
#include "Track.h"
#include "mavlink/ByteChannel.h"
#include "mavlink/MavlinkVehicle.h"
#include "px4/Px4Topics.h"
#include "px4/Px4Vehicle.h"

#include <rabit/node/RunNode.h>

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
    std::string TrackFile;
    std::string Mavlink;
    std::string Px4;
    Swarm::AircraftOptions Aircraft;
};

// A circle south of the field, beside those of the other aircraft, placed by the number at the end of the
// name.
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
    if (!options.Px4.empty())
        return std::make_unique<Swarm::Px4Vehicle>(*Rabit::RabitWorkspace::GetWorkspace());
    if (!options.Mavlink.empty())
        return std::make_unique<Swarm::MavlinkVehicle>(Swarm::OpenByteChannel(options.Mavlink));
    return std::make_unique<Swarm::SimulatedVehicle>(
        options.TrackFile.empty() ? Swarm::Flight(PatternFor(node))
                                  : Swarm::Flight(Swarm::Track::Load(options.TrackFile)));
}

void AddManagers(Rabit::RabitReactor &reactor, Rabit::GatewayConfig &config, const Options &options)
{
    if (!options.Px4.empty())
        Swarm::AddPx4Topics(config, Swarm::Px4Namespace(options.Px4));
    Swarm::CompleteAircraftConfig(config, options.Aircraft.Ground);
    const Swarm::Names names(config.Node, config.Node);
    reactor.AddManager(std::make_unique<Swarm::Autopilot>(names, MakeVehicle(options, config.Node)));
    reactor.AddManager(std::make_unique<Swarm::MissionControl>(names, options.Aircraft.Ground,
                                                               options.Aircraft.MissionFloor()));
    const bool isSimulated = options.Mavlink.empty() && options.Px4.empty();
    reactor.AddManager(std::make_unique<Swarm::HealthMonitor>(names, options.Aircraft.Health(isSimulated)));
}

void AddOptions(CLI::App &app, Options &options)
{
    app.add_option("--track", options.TrackFile, "CSV file of the track to fly (default: circles)");
    auto *const px4 =
        app.add_option("--px4", options.Px4,
                       "A real PX4 in place of the simulated one, through its DDS agent: `dds`, or "
                       "`dds:/px4_1` for one whose topics are below that")
            ->check(Swarm::IsPx4);
    app.add_option("--mavlink", options.Mavlink,
                   "A real autopilot in place of the simulated one: `udp:PORT` where it sends to on this "
                   "machine, `udp:ADDRESS:PORT` with the address of the interface that it is on, or "
                   "`serial:DEVICE:BAUD`")
        ->excludes(px4);
    options.Aircraft.AddTo(app);
}
}  // namespace

int main(int argc, char **argv)
{
    Options options;
    Rabit::NodeProgram program;
    program.Description = "An aircraft of the example fleet.";
    program.ConfigFile = "uav.yaml";
    program.AddOptions = [&options](CLI::App &app) { AddOptions(app, options); };
    program.AddManagers = [&options](Rabit::RabitReactor &reactor, Rabit::GatewayConfig &config)
    { AddManagers(reactor, config, options); };
    return Rabit::RunNode(argc, argv, program);
}
