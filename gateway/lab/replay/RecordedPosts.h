#pragma once

#include <rabit/RabitManager.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/idl/MessageType.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "recording/replay/PostTimes.h"
#include "recording/replay/ReplayItem.h"
#include "recording/replay/ReplayPlan.h"

namespace Rabit::WhatIf
{

// Posts and sends what a node did.
class RecordedPosts
{
public:
    // Adds the published messages to the workspace, which must outlive the object.
    RecordedPosts(RabitWorkspace &workspace, const GatewayConfig &config);

    // Posts a message, as old as when it was recorded, or puts it into its queue. Returns when it was posted,
    // by the monotonic clock of the workspace; nothing if it was not posted.
    std::optional<std::chrono::nanoseconds> Play(const Replay::ReplayItem &item,
                                                 const Replay::ReplayStream &stream,
                                                 Replay::PostTimes &times);

private:
    struct Posted
    {
        std::shared_ptr<RabitMessage> Message;
        const MessageType *Type = nullptr;
    };
    RabitWorkspace &_workspace;
    std::map<std::string, Posted> _posted;
};

// Empties its queue, as a manager that is never late.
class QueueTaker final : public RabitManager
{
public:
    using RabitManager::RabitManager;
    void ExecuteUnitOfWork() final;
};

}  // namespace Rabit::WhatIf
