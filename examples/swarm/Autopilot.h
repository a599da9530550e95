#pragma once

#include "Flight.h"
#include "Schedule.h"
#include "uav.idl.h"

#include <rabit/RabitManager.h>

#include <chrono>
#include <cstdint>
#include <memory>

namespace Swarm
{

// Flies the simulated aircraft: the manager `Autopilot`.
//
// Posts:  Pose (Uav::Pose), ten times a second; FlightMode (Uav::FlightMode), at the start and when it
// changes. Queue:  Autopilot takes Uav::Goto, checked before; it flies there at once.
class Autopilot : public Rabit::RabitManager
{
public:
    static constexpr std::chrono::milliseconds PosePeriod{100};

    Autopilot(Flight flight, Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void Startup() final;
    void ExecuteUnitOfWork() final;

private:
    void TakeCommands(double seconds);
    void PostPose(const Motion &motion);
    void PostModeIfChanged();

    Flight _flight;
    Schedule _poseTimes{PosePeriod};
    std::chrono::nanoseconds _start{0};
    std::uint32_t _command = 0;
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::FlightMode> _mode = std::make_shared<Uav::FlightMode>();
};

}  // namespace Swarm
