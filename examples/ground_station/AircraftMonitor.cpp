#include "AircraftMonitor.h"

#include "WireNames.h"

#include <rabit/PublishSubscribeMessage.h>

#include <boost/algorithm/string/case_conv.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace Ground
{
namespace
{
// Commands of another ground station, or of an earlier incarnation of this one, have no number here.
std::string WithNumber(const std::string &mode, std::uint32_t id, const CommandTally &tally)
{
    const std::uint32_t index = id - tally.first_id;
    return index < tally.commands ? mode + " " + std::to_string(index + 1) : mode;
}

double MonotonicS(const Rabit::RabitWorkspace &workspace)
{
    return std::chrono::duration<double>(workspace.GetClock().Monotonic()).count();
}

std::string MissionText(const Uav::MissionState &mission, const CommandTally &tally)
{
    const bool isCommanded =
        mission.mode == Uav::MissionMode::MISSION_GOTO || mission.mode == Uav::MissionMode::MISSION_HOLD;
    const std::string mode = boost::algorithm::to_upper_copy(WireName(mission.mode));
    return isCommanded ? WithNumber(mode, mission.last_command, tally) : mode;
}
}  // namespace

AircraftMonitor::AircraftMonitor(std::string node, Rabit::RabitWorkspace &workspace)
    : _node(std::move(node)), _workspace(workspace)
{
    workspace.AddPublishSubscribeMessage(_node + "/Pose", _pose);
    workspace.AddPublishSubscribeMessage(_node + "/MissionState", _mission);
    workspace.AddPublishSubscribeMessage(_node + "/Health", _health);
    workspace.AddPublishSubscribeMessage(_node + "/Findings", _findings);
    workspace.AddPublishSubscribeMessage(_node + ".vision/Targets", _targets);
    workspace.AddPublishSubscribeMessage(_node + "/Pose", _arrivals->Pose);
    workspace.AddPublishSubscribeMessage(_node + "/MissionState", _arrivals->Mission);

    const auto pose = _arrivals->Pose->GetGlobalPublishSubscribeMessageRef();
    const auto mission = _arrivals->Mission->GetGlobalPublishSubscribeMessageRef();
    if (!pose || !mission)
        return;  // the names belong to messages of other types; the workspace has logged that
    // Quick handlers see each sample, not only the newest.
    _onPose = pose->ConnectSomethingPublished(Rabit::RabitQuickHandler(
        [arrivals = _arrivals]
        {
            const std::lock_guard lock(arrivals->Mutex);
            if (arrivals->Pose->FetchMessage())
                arrivals->Count.OnPose(arrivals->Pose->number);
        }));
    _onMission = mission->ConnectSomethingPublished(Rabit::RabitQuickHandler(
        [arrivals = _arrivals]
        {
            const std::lock_guard lock(arrivals->Mutex);
            if (arrivals->Mission->FetchMessage())
                arrivals->Count.OnMissionState(arrivals->Mission->poses);
        }));
}

void AircraftMonitor::Show(FleetRow &row, const CommandTally &tally)
{
    if (!_pose->GetGlobalPublishSubscribeMessageRef() || !_mission->GetGlobalPublishSubscribeMessageRef())
        return;
    if (_pose->FetchMessage() && _pose->WasPosted())
        _badPosition = _check.Look(*_pose, MonotonicS(_workspace) - _pose->GetAgeSeconds());
    _mission->FetchMessage();
    if (_pose->WasPosted())
    {
        row.AgeS = _pose->GetAgeSeconds();
        row.BadPosition = _badPosition;
        row.LatitudeDeg = _pose->latitude_deg;
        row.LongitudeDeg = _pose->longitude_deg;
        row.AltitudeM = _pose->altitude_m;
        row.SpeedMps = std::hypot(static_cast<double>(_pose->velocity_north_mps),
                                  static_cast<double>(_pose->velocity_east_mps),
                                  static_cast<double>(_pose->velocity_down_mps));
    }
    if (_health->GetGlobalPublishSubscribeMessageRef())
        _health->FetchMessage();
    if (_health->WasPosted() && _health->GetAgeSeconds() <= FleetRow::HealthFreshS &&
        std::isfinite(_health->battery_percent))
        row.BatteryPercent = std::clamp(static_cast<double>(_health->battery_percent), 0.0, 100.0);
    if (!_mission->WasPosted())
        return;
    row.Mission = MissionText(*_mission, tally);
    row.AreaDeclined = _mission->area_declined;
}

SaidOfTargets AircraftMonitor::Targets()
{
    SaidOfTargets said;
    said.Aircraft = _node;
    if (_findings->GetGlobalPublishSubscribeMessageRef())
        _findings->FetchMessage();
    said.Findings = &_findings->items;
    if (_targets->GetGlobalPublishSubscribeMessageRef())
        _targets->FetchMessage();
    if (_targets->WasPosted())
    {
        said.Targets = _targets.get();
        said.AgeS = _targets->GetAgeSeconds();
    }
    return said;
}

PoseCount AircraftMonitor::Count() const
{
    const std::lock_guard lock(_arrivals->Mutex);
    return _arrivals->Count;
}

}  // namespace Ground
