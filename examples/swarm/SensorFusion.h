#pragma once

#include "Names.h"
#include "Schedule.h"
#include "uav.idl.h"
#include "vision/TargetTable.h"

#include <rabit/RabitManager.h>

#include <chrono>
#include <memory>

namespace Swarm
{

// Makes targets of what the cameras of this aircraft and of the others detect: the manager `SensorFusion`.
//
// Queue: SensorFusion takes Uav::Detections.
// Posts: Targets (Uav::Targets), after each batch of frames and every second.
class SensorFusion : public Rabit::RabitManager
{
public:
    static constexpr std::chrono::seconds ReportPeriod{1};

    explicit SensorFusion(const Names &names,
                          Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void ExecuteUnitOfWork() final;

private:
    bool TakeFrames();

    TargetTable _table;
    Schedule _reportTimes{ReportPeriod};
    std::shared_ptr<Uav::Targets> _targets = std::make_shared<Uav::Targets>();
};

}  // namespace Swarm
