#include "Autopilot.h"

#include <rabit/RabitLog.h>

#include <utility>

namespace Swarm
{
namespace
{
Uav::MissionMode ModeOf(FlightPhase phase)
{
    switch (phase)
    {
        case FlightPhase::Idle:
            return Uav::MissionMode::MISSION_IDLE;
        case FlightPhase::Track:
            return Uav::MissionMode::MISSION_TRACK;
        case FlightPhase::Pattern:
            return Uav::MissionMode::MISSION_PATTERN;
        case FlightPhase::Goto:
            return Uav::MissionMode::MISSION_GOTO;
        case FlightPhase::Hold:
            return Uav::MissionMode::MISSION_HOLD;
    }
    return Uav::MissionMode::MISSION_IDLE;
}
}  // namespace

Autopilot::Autopilot(std::unique_ptr<Vehicle> vehicle, Rabit::RabitWorkspace &workspace)
    : RabitManager("Autopilot", workspace), _vehicle(std::move(vehicle))
{
    AddPublishSubscribeMessage("Pose", _pose);
    AddPublishSubscribeMessage("FlightMode", _mode);
}

void Autopilot::Startup()
{
    _vehicle->Start(GetWorkspace().GetClock().Monotonic());
}

void Autopilot::ExecuteUnitOfWork()
{
    const std::chrono::nanoseconds now = GetWorkspace().GetClock().Monotonic();
    TakeCommands(now);
    const std::optional<Motion> motion = _vehicle->Update(now);
    PostModeIfChanged(now);
    if (motion)
        PostPose(*motion);
    SetWakeupTimeDelayMSec(_vehicle->DelayMSec(GetWorkspace().GetClock().Monotonic()));
}

void Autopilot::TakeCommands(std::chrono::nanoseconds now)
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
    {
        if (const auto *command = dynamic_cast<const Uav::Goto *>(message.get()))
        {
            const std::string problem = _vehicle->NotReady(now);
            if (!problem.empty())
            {
                Rabit::RabitLog::Write(
                    Rabit::RabitLogLevel::Warning,
                    "autopilot: command " + std::to_string(command->id) + " is not flown: " + problem);
                continue;
            }
            _vehicle->FlyTo({command->latitude_deg, command->longitude_deg, command->altitude_m},
                            command->speed_mps, now);
            _command = command->id;
        }
    }
}

void Autopilot::PostPose(const Motion &motion)
{
    _pose->latitude_deg = motion.Position.LatitudeDeg;
    _pose->longitude_deg = motion.Position.LongitudeDeg;
    _pose->altitude_m = motion.Position.AltitudeM;
    _pose->velocity_north_mps = static_cast<float>(motion.NorthMps);
    _pose->velocity_east_mps = static_cast<float>(motion.EastMps);
    _pose->velocity_down_mps = static_cast<float>(motion.DownMps);
    _pose->roll_rad = static_cast<float>(motion.RollRad);
    _pose->pitch_rad = static_cast<float>(motion.PitchRad);
    _pose->yaw_rad = static_cast<float>(motion.YawRad);
    _pose->gps_time_s = GetWorkspace().GetClock().GpsTimeSeconds();
    ++_pose->number;
    _pose->PostMessage();
}

void Autopilot::PostModeIfChanged(std::chrono::nanoseconds now)
{
    const Uav::MissionMode mode = ModeOf(_vehicle->Phase());
    const std::string notReady = _vehicle->NotReady(now);
    if (_mode->WasPosted() && _mode->mode == mode && _mode->command == _command &&
        _mode->not_ready == notReady)
        return;
    _mode->mode = mode;
    _mode->command = _command;
    _mode->not_ready = notReady;
    _mode->PostMessage();
}

}  // namespace Swarm
