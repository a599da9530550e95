#pragma once

#include "Names.h"
#include "Schedule.h"
#include "uav.idl.h"

#include <rabit/RabitWorkspace.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Swarm
{

// The other aircraft: all whose Pose is in this workspace, posted by managers of this process or mirrored
// by the gateway. Only for the manager's thread.
class OtherAircraft
{
public:
    // An aircraft whose pose is older than this counts as absent.
    static constexpr double MaxAgeS = 3;
    // Interval at which new aircraft are looked for.
    static constexpr std::chrono::seconds LookPeriod{1};

    // The workspace must outlive this object.
    OtherAircraft(Names names, Rabit::RabitWorkspace &workspace);

    // The poses of the aircraft that are present now, by name.
    std::map<std::string, Uav::Pose> Poses();
    // The findings of all aircraft that were ever present.
    std::map<std::string, Uav::Findings> Findings();

private:
    void Look();

    const Names _names;
    Rabit::RabitWorkspace &_workspace;
    Schedule _looks{LookPeriod};
    std::map<std::string, std::shared_ptr<Uav::Pose>> _poses;
    std::map<std::string, std::shared_ptr<Uav::Findings>> _findings;
};

}  // namespace Swarm
