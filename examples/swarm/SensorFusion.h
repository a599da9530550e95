#pragma once

#include "Names.h"
#include "OtherAircraft.h"
#include "uav.idl.h"
#include "vision/TargetTable.h"

#include <rabit/RabitManager.h>
#include <rabit/RabitTimer.h>

#include <chrono>
#include <memory>

namespace Swarm
{

// Makes targets from the detections by the cameras of all aircraft: the manager `SensorFusion`.
//
// Queue: SensorFusion takes Uav::Detections, and Uav::Targets from the sensor fusion of other aircraft.
// Posts: Targets (Uav::Targets), after each batch of messages and every second.
// Sends: Uav::Targets, those whose names the others may not know, to the queue SensorFusion of each of them.
// Fetches: Pose of the others, to know their names.
class SensorFusion : public Rabit::RabitManager
{
public:
    static constexpr std::chrono::seconds ReportPeriod{1};

    explicit SensorFusion(const Names &names,
                          Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void ExecuteUnitOfWork() final;

private:
    bool TakeMessages();
    void TellOthers(double gpsTimeS);

    const Names _names;
    TargetTable _table;
    OtherAircraft _others;
    Rabit::RabitTimer _reportTimes{ReportPeriod};
    std::shared_ptr<Uav::Targets> _targets = std::make_shared<Uav::Targets>();
};

}  // namespace Swarm
