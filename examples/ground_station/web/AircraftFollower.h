#pragma once

#include "PositionCheck.h"
#include "StationData.h"

#include <rabit/RabitWorkspace.h>

#include <memory>
#include <string>

namespace Ground
{

// Follows the messages of one aircraft: Pose, MissionState, Findings and Health of <node>, and Targets and
// CameraView of <node>.vision. Not thread-safe.
class AircraftFollower
{
public:
    // Registers the names in the workspace, which must outlive this object.
    AircraftFollower(const std::string &node, Rabit::RabitWorkspace &workspace);

    // Fetches the latest of each, and fills in the messages that have come, with their ages. The data
    // points into this object. The pose is the last one with a good position: it grows old while bad ones
    // come.
    void Show(AircraftData &data);
    // Seconds since that time by the clock of the aircraft, computed from its last pose, which carries that
    // clock and has an age. NaN if there is no pose. Call it after Show, which fetches the pose.
    double SecondsSince(double gpsTimeS) const;

private:
    void LookAtPose(AircraftData &data);

    Rabit::RabitWorkspace &_workspace;
    PositionCheck _check;
    std::string _badPosition;                                              // of the newest pose
    std::shared_ptr<Uav::Pose> _goodPose = std::make_shared<Uav::Pose>();  // registered under no name
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::MissionState> _mission = std::make_shared<Uav::MissionState>();
    std::shared_ptr<Uav::Findings> _findings = std::make_shared<Uav::Findings>();
    std::shared_ptr<Uav::Health> _health = std::make_shared<Uav::Health>();
    std::shared_ptr<Uav::Targets> _targets = std::make_shared<Uav::Targets>();
    std::shared_ptr<Uav::CameraView> _camera = std::make_shared<Uav::CameraView>();
};

}  // namespace Ground
