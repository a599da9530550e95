// The vision node of one simulated aircraft: a camera, the sensor fusion, and the gateway that joins them
// to the other nodes.
#include "AircraftConfig.h"
#include "ImageProcessing.h"
#include "Names.h"
#include "SensorFusion.h"
#include "vision/World.h"

#include <rabit/node/RunNode.h>

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <string>

int main(int argc, char **argv)
{
    std::string worldFile = "world.yaml";
    Rabit::NodeProgram program;
    program.Description = "The camera and sensor fusion of a simulated aircraft of the example fleet.";
    program.ConfigFile = "vision.yaml";
    program.AddOptions = [&worldFile](CLI::App &app)
    {
        app.add_option("--world", worldFile,
                       "YAML file of what there is to see on the ground (default: world.yaml)");
    };
    program.AddManagers = [&worldFile](Rabit::RabitReactor &reactor, const Rabit::GatewayConfig &config)
    {
        const Swarm::Names names(Swarm::AircraftOf(config.Node), config.Node);
        const Swarm::World world = Swarm::World::Load(worldFile);
        const std::size_t seed = std::hash<std::string>()(config.Node);  // each camera misses different
                                                                         // targets
        reactor.AddManager(std::make_unique<Swarm::ImageProcessing>(names, world, seed));
        reactor.AddManager(std::make_unique<Swarm::SensorFusion>(names));
    };
    return Rabit::RunNode(argc, argv, program);
}
