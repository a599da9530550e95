#include "SensorFusion.h"

namespace Swarm
{

SensorFusion::SensorFusion(const Names &names, Rabit::RabitWorkspace &workspace)
    : RabitManager(names.OwnVision("SensorFusion"), workspace), _table(names.Aircraft())
{
    AddPublishSubscribeMessage(names.OwnVision("Targets"), _targets);
}

void SensorFusion::ExecuteUnitOfWork()
{
    Rabit::RabitClock &clock = GetWorkspace().GetClock();
    const bool due = _reportTimes.Due(clock.Monotonic());
    if (TakeFrames() || due)
    {
        _table.Report(clock.GpsTimeSeconds(), *_targets);
        _targets->PostMessage();
    }
    SetWakeupTimeDelayMSec(_reportTimes.DelayMSec(clock.Monotonic()));
}

bool SensorFusion::TakeFrames()
{
    bool any = false;
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
        if (const auto *frame = dynamic_cast<const Uav::Detections *>(message.get()))
        {
            _table.Add(*frame);
            any = true;
        }
    return any;
}

}  // namespace Swarm
