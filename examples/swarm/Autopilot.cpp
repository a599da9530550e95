#include "Autopilot.h"

#include <utility>

namespace Swarm
{
namespace
{
Uav::MissionMode ModeOf(FlightPhase phase)
{
    switch (phase)
    {
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

Autopilot::Autopilot(Flight flight, Rabit::RabitWorkspace &workspace)
    : RabitManager("Autopilot", workspace), _flight(std::move(flight))
{
    AddPublishSubscribeMessage("Pose", _pose);
    AddPublishSubscribeMessage("FlightMode", _mode);
}

void Autopilot::Startup()
{
    _start = GetWorkspace().GetClock().Monotonic();
}

void Autopilot::ExecuteUnitOfWork()
{
    const std::chrono::nanoseconds now = GetWorkspace().GetClock().Monotonic();
    const double seconds = std::chrono::duration<double>(now - _start).count();
    TakeCommands(seconds);
    const Motion motion = _flight.At(seconds);
    PostModeIfChanged();
    if (_poseTimes.Due(now))
        PostPose(motion);
    SetWakeupTimeDelayMSec(_poseTimes.DelayMSec(GetWorkspace().GetClock().Monotonic()));
}

void Autopilot::TakeCommands(double seconds)
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
    {
        if (const auto *command = dynamic_cast<const Uav::Goto *>(message.get()))
        {
            _flight.FlyTo({command->latitude_deg, command->longitude_deg, command->altitude_m},
                          command->speed_mps, seconds);
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

void Autopilot::PostModeIfChanged()
{
    const Uav::MissionMode mode = ModeOf(_flight.Phase());
    if (_mode->WasPosted() && _mode->mode == mode && _mode->command == _command)
        return;
    _mode->mode = mode;
    _mode->command = _command;
    _mode->PostMessage();
}

}  // namespace Swarm
