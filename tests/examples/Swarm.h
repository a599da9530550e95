// Two whole aircraft, and the helpers of the tests that fly them.
#pragma once

#include "Autopilot.h"
#include "HealthMonitor.h"
#include "ImageProcessing.h"
#include "MissionControl.h"
#include "Names.h"
#include "SensorFusion.h"
#include "SimulatedVehicle.h"
#include "vision/World.h"

#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitWorkspace.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace SwarmTest
{

inline const Swarm::GeoPoint Field{47.3977, 8.5456, 500};

// One target that stands in the middle of the first lane of uav1.
inline Swarm::World WorldOfOneTarget()
{
    Swarm::World world;
    world.GroundM = 430;
    world.Targets.push_back({Swarm::Moved({Field.LatitudeDeg, Field.LongitudeDeg, 430}, {-75, -60, 0})});
    return world;
}

inline Uav::SearchArea Area()
{
    Uav::SearchArea area;
    area.number = 3;
    area.latitude_deg = Field.LatitudeDeg;
    area.longitude_deg = Field.LongitudeDeg;
    area.north_m = 200;
    area.east_m = 400;
    area.altitude_m = 510;
    area.speed_mps = 16;
    area.lane_m = 50;
    return area;
}

// The managers of the aircraft's first process, flying circles 250 m south of the field.
inline void AddFlyingManagers(Rabit::RabitSteppedReactor &reactor, Rabit::RabitWorkspace &workspace,
                              const Swarm::Names &names, double eastM)
{
    const Swarm::Circle circle{Swarm::Moved(Field, {-250, eastM, 0}), 60, 12};
    reactor.AddManager(std::make_unique<Swarm::Autopilot>(
        names, std::make_unique<Swarm::SimulatedVehicle>(Swarm::Flight(circle)), workspace));
    reactor.AddManager(std::make_unique<Swarm::MissionControl>(names, "ground", Swarm::Floor(), workspace));
    reactor.AddManager(std::make_unique<Swarm::HealthMonitor>(
        names, Swarm::HealthMonitor::Options{.EnduranceS = 2400.0}, workspace));
}

// The managers of the aircraft's second process.
inline void AddSeeingManagers(Rabit::RabitSteppedReactor &reactor, Rabit::RabitWorkspace &workspace,
                              const Swarm::Names &names, std::uint64_t seed)
{
    reactor.AddManager(std::make_unique<Swarm::ImageProcessing>(names, WorldOfOneTarget(), seed, workspace));
    reactor.AddManager(std::make_unique<Swarm::SensorFusion>(names, workspace));
}

// Returns the newest contents of a message; a default one if the name is not registered.
template <typename Message>
Message Latest(Rabit::RabitWorkspace &workspace, const std::string &name)
{
    Message message;
    workspace.ForceFetchMessage(name, &message);
    return message;
}

}  // namespace SwarmTest
