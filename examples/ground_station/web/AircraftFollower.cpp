#include "AircraftFollower.h"

#include <chrono>
#include <limits>

namespace Ground
{
AircraftFollower::AircraftFollower(const std::string &node, Rabit::RabitWorkspace &workspace)
    : _workspace(workspace)
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
    LookAtPose(data);
    data.Mission = Latest(*_mission);
    data.Findings = Latest(*_findings);
    data.Health = Latest(*_health);
    data.Targets = Latest(*_targets);
    data.Camera = Latest(*_camera);
}

void AircraftFollower::LookAtPose(AircraftData &data)
{
    if (!_pose->GetGlobalPublishSubscribeMessageRef())
        return;  // the name belongs to a message of another type, which the workspace has logged
    const Rabit::RabitClock &clock = _workspace.GetClock();
    if (_pose->FetchMessage() && _pose->WasPosted())
    {
        const double nowS = std::chrono::duration<double>(clock.Monotonic()).count();
        _badPosition = _check.Look(*_pose, nowS - _pose->GetAgeSeconds());
        if (_badPosition.empty())
            _goodPose->CopyMessage(_pose.get());
    }
    data.BadPosition = _badPosition;
    if (_goodPose->WasPosted())
        data.Pose = {_goodPose.get(), _goodPose->GetAgeSeconds(clock)};
}

double AircraftFollower::SecondsSince(double gpsTimeS) const
{
    if (!_pose->WasPosted())
        return std::numeric_limits<double>::quiet_NaN();
    return _pose->gps_time_s + _pose->GetAgeSeconds() - gpsTimeS;
}

}  // namespace Ground
