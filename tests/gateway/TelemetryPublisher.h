#pragma once

#include <rabit/ManualClock.h>
#include <rabit/RabitWorkspace.h>

#include <memory>

#include "OneWriterNetwork.h"
#include "mirrors/TopicPublisher.h"
#include "uav.idl.h"

namespace Rabit
{

// A publisher of the telemetry `Pose`, with a local message that is posted. It is not attached yet.
struct TelemetryPublisher
{
    explicit TelemetryPublisher(double maxRate = 0.0)
        : Publisher(
              {.Message = "Pose", .Type = "Uav::Pose", .Qos = QosProfile::Telemetry, .MaxRate = maxRate},
              Uav::Pose::IdlType(), "uav1", SourceClock(ManualClock()), Session)
    {
        Workspace.AddPublishSubscribeMessage("Pose", Pose);
        Workspace.AddPublishSubscribeMessage("Pose", Publisher.Local());
    }

    OneWriter::Network Network;
    OneWriter::Session Session{Network};
    TopicPublisher Publisher;
    RabitWorkspace Workspace;
    std::shared_ptr<Uav::Pose> Pose = std::make_shared<Uav::Pose>();
};

}  // namespace Rabit
