#pragma once

#include "FleetTable.h"
#include "FleetTargets.h"
#include "PoseCount.h"
#include "PositionCheck.h"
#include "ground.idl.h"
#include "uav.idl.h"

#include <rabit/RabitWorkspace.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace Ground
{

// Follows the mirrored messages <node>/Pose, <node>/MissionState, <node>/Health, <node>/Findings and
// <node>.vision/Targets of one aircraft.
//
// Fetch gives a manager the latest of each. But a manager that sleeps between fetches cannot count
// messages. So a handler counts each arrival on the posting thread, which is the transport's.
class AircraftMonitor
{
public:
    // Registers these names in the workspace, which must outlive this object.
    AircraftMonitor(std::string node, Rabit::RabitWorkspace &workspace);

    // Fills in the row's pose, its age, why its position is bad, the battery, the mission and the reason if
    // the search area is declined. The tally gives the numbers by which people know the commands. Only for
    // the manager's thread.
    void Show(FleetRow &row, const CommandTally &tally = {});
    // The last targets and findings of the aircraft; valid until the next call. Only for the same thread.
    SaidOfTargets Targets();
    // May be called from any thread.
    PoseCount Count() const;

private:
    // Shared with the handlers, which may still run after this object is destroyed.
    struct Arrivals
    {
        std::mutex Mutex;
        std::shared_ptr<Uav::Pose> Pose = std::make_shared<Uav::Pose>();
        std::shared_ptr<Uav::MissionState> Mission = std::make_shared<Uav::MissionState>();
        PoseCount Count;
    };

    const std::string _node;
    Rabit::RabitWorkspace &_workspace;
    PositionCheck _check;
    std::string _badPosition;  // of the last pose
    std::shared_ptr<Arrivals> _arrivals = std::make_shared<Arrivals>();
    Rabit::RabitScopedConnection _onPose;
    Rabit::RabitScopedConnection _onMission;
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::MissionState> _mission = std::make_shared<Uav::MissionState>();
    std::shared_ptr<Uav::Health> _health = std::make_shared<Uav::Health>();
    std::shared_ptr<Uav::Findings> _findings = std::make_shared<Uav::Findings>();
    std::shared_ptr<Uav::Targets> _targets = std::make_shared<Uav::Targets>();
};

}  // namespace Ground
