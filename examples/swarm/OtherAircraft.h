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

// The other aircraft: whoever's Pose is heard in this workspace, be it posted by managers of this process or
// mirrored by the gateway. For one thread: the manager's.
class OtherAircraft
{
public:
    // An aircraft whose pose is older than this counts as not there.
    static constexpr double MaxAgeS = 3;
    // New ones are looked for this often.
    static constexpr std::chrono::seconds LookPeriod{1};

    // The workspace must outlive this object.
    OtherAircraft(Names names, Rabit::RabitWorkspace &workspace);

    // Where those are that are there now, by name.
    std::map<std::string, Uav::Pose> Poses();
    // What they have found, of all that were ever there.
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
