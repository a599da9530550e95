// Command-line options of an aircraft's mission control and health monitor, in flight and in uav_rerun.
#pragma once

#include "HealthMonitor.h"
#include "mission/Floor.h"

#include <string>

namespace CLI
{
class App;
}

namespace Swarm
{

struct AircraftOptions
{
    std::string Ground = "ground";  // the node of the ground station
    double EnduranceMinutes = 40;   // of a simulated battery
    Swarm::Floor::Settings Floor;
    std::string WorldFile;  // empty: none

    void AddTo(CLI::App &app);
    HealthMonitor::Options Health(bool isSimulated) const;
    // Throws Swarm::WorldError.
    Swarm::Floor MissionFloor() const;
};

}  // namespace Swarm
