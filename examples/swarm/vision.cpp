// The eyes of one simulated aircraft: a camera, what makes targets of its detections, and the gateway that
// joins them to the other nodes.
#include "AircraftConfig.h"
#include "ImageProcessing.h"
#include "Names.h"
#include "NodeProgram.h"
#include "SensorFusion.h"
#include "vision/World.h"

#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <string>

namespace
{
struct Options
{
    Common::NodeOptions Node{.ConfigFile = "vision.yaml"};
    std::string WorldFile = "world.yaml";
};

int Look(const Options &options)
{
    const Rabit::GatewayConfig config = Common::LoadConfig(options.Node);
    const Swarm::Names names(Swarm::AircraftOf(config.Node), config.Node);
    const Swarm::World world = Swarm::World::Load(options.WorldFile);
    if (options.Node.Check)
        return 0;
    const std::size_t seed = std::hash<std::string>()(config.Node);  // each camera misses something else
    Rabit::RabitReactor reactor;
    reactor.AddManager(std::make_unique<Swarm::ImageProcessing>(names, world, seed));
    reactor.AddManager(std::make_unique<Swarm::SensorFusion>(names));
    reactor.AddManager(
        std::make_unique<Rabit::GatewayManager>(config, Rabit::MakeTransport(config.Transport)));
    reactor.Run();  // until SIGINT or SIGTERM
    return 0;
}
}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("The camera and sensor fusion of a simulated aircraft of the example fleet.");
    Options options;
    Common::Describe(app, options.Node);
    app.add_option("--world", options.WorldFile,
                   "YAML file of what there is to see on the ground (default: world.yaml)");
    return Common::RunProgram(app, argc, argv, [&] { return Look(options); });
}
