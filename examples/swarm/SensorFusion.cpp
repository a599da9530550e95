#include "SensorFusion.h"

namespace Swarm
{

SensorFusion::SensorFusion(const Names &names, Rabit::RabitWorkspace &workspace)
    : RabitManager(names.OwnVision("SensorFusion"), workspace),
      _names(names),
      _table(names.Aircraft()),
      _others(names, *this)
{
    AddPublishSubscribeMessage(names.OwnVision("Targets"), _targets);
}

void SensorFusion::ExecuteUnitOfWork()
{
    const bool due = _reportTimes.IsDue(*this);
    if (TakeMessages() || due)
    {
        const double now = GetWorkspace().GetClock().GpsTimeSeconds();
        TellOthers(now);
        _table.Report(now, *_targets);
        _targets->PostMessage();
    }
    Rabit::RabitTimer::SleepUntilDue(*this, {&_reportTimes});
}

bool SensorFusion::TakeMessages()
{
    bool any = false;
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
        if (const auto *frame = dynamic_cast<const Uav::Detections *>(message.get()))
        {
            _table.Add(*frame);
            any = true;
        }
        else if (const auto *told = dynamic_cast<const Uav::Targets *>(message.get()))
        {
            _table.Hear(*told);
            any = true;
        }
    return any;
}

// Sends the targets to tell. Lost messages do no harm: TargetTable::Tell repeats names after a while.
void SensorFusion::TellOthers(double gpsTimeS)
{
    const auto told = std::make_shared<Uav::Targets>(_table.Tell(gpsTimeS));
    if (told->items.empty())
        return;
    for (const auto &[aircraft, pose] : _others.Poses())
        AddMessageToQueue(_names.Of(Names::VisionOf(aircraft), "SensorFusion"), told);
}

}  // namespace Swarm
