#pragma once

#include "FleetTable.h"
#include "FleetTargets.h"
#include "PoseCount.h"
#include "ground.idl.h"
#include "uav.idl.h"

#include <rabit/RabitWorkspace.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace Ground
{

// Follows the mirrored messages <node>/Pose, <node>/MissionState, <node>/Findings and <node>.vision/Targets
// of one aircraft.
//
// Fetch gives a manager the latest of each. A manager that sleeps between fetches cannot count messages,
// though, so each arrival is counted by a handler on the thread that posts it, which is the transport's.
class AircraftMonitor
{
public:
    // Registers these names in the workspace, which must outlive this object.
    AircraftMonitor(std::string node, Rabit::RabitWorkspace &workspace);

    // Fills in the row's pose, its age, the mission and what of it is declined. The tally says by which
    // numbers people know the commands. For one thread: the manager's.
    void Show(FleetRow &row, const CommandTally &tally = {});
    // What it said last of targets; valid until it is called again. For the same thread.
    SaidOfTargets Targets();
    // Any thread.
    PoseCount Count() const;

private:
    // Shared with the handlers, which may still run when this object is gone.
    struct Arrivals
    {
        std::mutex Mutex;
        std::shared_ptr<Uav::Pose> Pose = std::make_shared<Uav::Pose>();
        std::shared_ptr<Uav::MissionState> Mission = std::make_shared<Uav::MissionState>();
        PoseCount Count;
    };

    const std::string _node;
    std::shared_ptr<Arrivals> _arrivals = std::make_shared<Arrivals>();
    Rabit::RabitScopedConnection _onPose;
    Rabit::RabitScopedConnection _onMission;
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::MissionState> _mission = std::make_shared<Uav::MissionState>();
    std::shared_ptr<Uav::Findings> _findings = std::make_shared<Uav::Findings>();
    std::shared_ptr<Uav::Targets> _targets = std::make_shared<Uav::Targets>();
};

}  // namespace Ground
