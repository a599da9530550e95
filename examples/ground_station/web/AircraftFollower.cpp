#include "AircraftFollower.h"

#include <limits>

namespace Ground
{
AircraftFollower::AircraftFollower(const std::string &node, Rabit::RabitWorkspace &workspace)
{
    workspace.AddPublishSubscribeMessage(node + "/Pose", _pose);
    workspace.AddPublishSubscribeMessage(node + "/MissionState", _mission);
    workspace.AddPublishSubscribeMessage(node + "/Findings", _findings);
    workspace.AddPublishSubscribeMessage(node + "/Health", _health);
    workspace.AddPublishSubscribeMessage(node + ".vision/Targets", _targets);
    workspace.AddPublishSubscribeMessage(node + ".vision/CameraView", _camera);
}

void AircraftFollower::Show(AircraftData &data)
{
    data.Pose = Latest(*_pose);
    data.Mission = Latest(*_mission);
    data.Findings = Latest(*_findings);
    data.Health = Latest(*_health);
    data.Targets = Latest(*_targets);
    data.Camera = Latest(*_camera);
}

double AircraftFollower::SecondsSince(double gpsTimeS) const
{
    if (!_pose->WasPosted())
        return std::numeric_limits<double>::quiet_NaN();
    return _pose->gps_time_s + _pose->GetAgeSeconds() - gpsTimeS;
}

}  // namespace Ground
