#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <mutex>
#include <vector>

#include "common/RejoiningBackend.h"
#include "common/RejoiningEndpoint.h"
#include "common/SessionLog.h"
#include "common/TopicRegistry.h"
#include "common/UseGate.h"

namespace Rabit
{

// What the session shares with its writers and readers.
struct RejoiningShared
{
    explicit RejoiningShared(const TransportSettings &settings)
        : Log(std::make_shared<SessionLog>(settings)), Topics(Log)
    {
    }

    const std::shared_ptr<SessionLog> Log;
    // While there is no session of the backend, nobody else would refuse a topic that is impossible.
    TopicRegistry Topics;
    UseGate Gate;                                // of what the endpoints hold of the backend
    std::mutex Structure;                        // of the session and the list; taken before Gate
    std::unique_ptr<BackendSession> Inner;       // nullptr while it is not joined; guarded by Structure
    std::vector<RejoiningEndpoint *> Endpoints;  // guarded by Structure
};

// Enters the list as it is made, and opens itself if there is a session.
inline void Enter(RejoiningShared &shared, RejoiningEndpoint &endpoint)
{
    const std::lock_guard lock(shared.Structure);
    if (shared.Inner != nullptr)
    {
        endpoint.Open(*shared.Inner);
    }
    shared.Endpoints.push_back(&endpoint);
}

// Leaves it and closes, before the session can.
inline void Leave(RejoiningShared &shared, RejoiningEndpoint &endpoint)
{
    const std::lock_guard lock(shared.Structure);
    std::erase(shared.Endpoints, &endpoint);
    endpoint.Close();
}

}  // namespace Rabit
