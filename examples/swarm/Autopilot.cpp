#include "Autopilot.h"

#include <rabit/RabitLog.h>

#include <utility>

namespace Swarm
{

Autopilot::Autopilot(const Names &names, std::unique_ptr<Vehicle> vehicle, Rabit::RabitWorkspace &workspace)
    : RabitManager(names.Own("Autopilot"), workspace), _vehicle(std::move(vehicle))
{
    AddPublishSubscribeMessage(names.Own("Pose"), _pose);
    AddPublishSubscribeMessage(names.Own("FlightMode"), _mode);
}

void Autopilot::Startup()
{
    _vehicle->Start(GetWorkspace().GetClock().Monotonic());
}

void Autopilot::ExecuteUnitOfWork()
{
    const std::chrono::nanoseconds now = GetWorkspace().GetClock().Monotonic();
    TakeCourses(now);
    const std::optional<Motion> motion = _vehicle->Update(now);
    PostModeIfChanged(now);
    if (motion)
        PostPose(*motion);
    SetWakeupTimeDelayMSec(_vehicle->DelayMSec(GetWorkspace().GetClock().Monotonic()));
}

void Autopilot::TakeCourses(std::chrono::nanoseconds now)
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
        if (const auto *course = dynamic_cast<const Uav::Course *>(message.get()))
            Obey(*course, now);
}

void Autopilot::Obey(const Uav::Course &course, std::chrono::nanoseconds now)
{
    const std::string problem = _vehicle->NotReady(now);
    if (!problem.empty())
    {
        Rabit::RabitLog::Write(
            Rabit::RabitLogLevel::Warning,
            "autopilot: course " + std::to_string(course.number) + " is not flown: " + problem);
        return;
    }
    if (course.speed_mps > 0)
        _vehicle->FlyTo({course.latitude_deg, course.longitude_deg, course.altitude_m}, course.speed_mps,
                        now);
    else
        _vehicle->Release(now);
    _course = course.number;
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
    const Uav::FlightPhase phase = _vehicle->Phase();
    const std::string notReady = _vehicle->NotReady(now);
    if (_mode->WasPosted() && _mode->phase == phase && _mode->course == _course &&
        _mode->not_ready == notReady)
        return;
    _mode->phase = phase;
    _mode->course = _course;
    _mode->not_ready = notReady;
    _mode->PostMessage();
}

}  // namespace Swarm
