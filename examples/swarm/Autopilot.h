#pragma once

#include "Names.h"
#include "Vehicle.h"
#include "uav.idl.h"

#include <rabit/RabitManager.h>

#include <chrono>
#include <cstdint>
#include <memory>

namespace Swarm
{

// The interface to the vehicle: the manager `Autopilot`.
//
// Posts:  Pose (Uav::Pose), for each new motion of the vehicle, ten times a second if it is simulated;
// FlightMode (Uav::FlightMode), at the start and when it changes, with the reason if it would not fly a
// course now.
// Queue:  Autopilot takes Uav::Course, already checked, and flies there at once. A Course at speed 0 takes
// the last one back.
class Autopilot : public Rabit::RabitManager
{
public:
    Autopilot(const Names &names, std::unique_ptr<Vehicle> vehicle,
              Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void Startup() final;
    void ExecuteUnitOfWork() final;

private:
    void TakeCourses(std::chrono::nanoseconds now);
    void Obey(const Uav::Course &course, std::chrono::nanoseconds now);
    void PostPose(const Motion &motion);
    void PostModeIfChanged(std::chrono::nanoseconds now);

    const std::unique_ptr<Vehicle> _vehicle;
    std::uint32_t _course = 0;
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::FlightMode> _mode = std::make_shared<Uav::FlightMode>();
};

}  // namespace Swarm
