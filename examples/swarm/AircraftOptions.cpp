#include "AircraftOptions.h"

#include "Limits.h"
#include "NumberWithin.h"
#include "vision/World.h"

#include <CLI/CLI.hpp>

namespace Swarm
{

void AircraftOptions::AddTo(CLI::App &app)
{
    app.add_option("--ground", Ground, "Name of the ground station's node (default: ground)");
    app.add_option("--endurance", EnduranceMinutes, "Minutes that the simulated battery lasts (default: 40)")
        ->check(Common::NumberWithin({0.1, 10'000}));
    app.add_option("--floor", Floor.AboveSeaM,
                   "Metres above mean sea level: what would lead it lower is declined (default: none)")
        ->check(Common::NumberWithin(Common::AltitudeM));
    app.add_option("--ground-height", Floor.GroundM,
                   "Height of the ground where it flies, in metres above mean sea level: what would lead "
                   "it lower than --clearance above that is declined (default: not known)")
        ->check(Common::NumberWithin({-500, 9000}));
    app.add_option("--clearance", Floor.ClearanceM,
                   "Metres above the ground, where that is known (default: 30)")
        ->check(Common::NumberWithin({0, 1000}));
    app.add_option("--world", WorldFile,
                   "YAML file of a simulated world, whose `ground_m` is the height of the ground unless "
                   "--ground-height says otherwise");
}

HealthMonitor::Options AircraftOptions::Health(bool isSimulated) const
{
    HealthMonitor::Options health;
    health.Ground = Ground;
    if (isSimulated)
        health.EnduranceS = EnduranceMinutes * 60;
    return health;
}

Swarm::Floor AircraftOptions::MissionFloor() const
{
    Swarm::Floor::Settings floor = Floor;
    if (!WorldFile.empty() && !floor.GroundM)
        floor.GroundM = World::Load(WorldFile).GroundM;
    return Swarm::Floor(floor);
}

}  // namespace Swarm
