#pragma once

#include <rabit/transport/Transport.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "common/RejoiningEndpoint.h"
#include "common/SessionLog.h"
#include "common/UseGate.h"

namespace Rabit
{

// As long as Write may wait for the network.
constexpr std::chrono::milliseconds LongestWait{100};

// What the session shares with its writers and readers.
struct RejoiningShared
{
    explicit RejoiningShared(const TransportSettings &settings) : Log(std::make_shared<SessionLog>(settings))
    {
    }

    const std::shared_ptr<SessionLog> Log;
    UseGate Gate;                                // of what the endpoints hold of the backend
    std::mutex Structure;                        // of the session and the list; taken before Gate
    std::unique_ptr<TransportSession> Inner;     // nullptr while it cannot be joined; guarded by Structure
    std::vector<RejoiningEndpoint *> Endpoints;  // guarded by Structure
};

// Enters the list as it is made, and opens itself if there is a session.
template <typename Made>
void Enter(RejoiningShared &shared, Made &endpoint)
{
    const std::lock_guard lock(shared.Structure);
    if (shared.Inner != nullptr)
    {
        endpoint.Open(*shared.Inner);
    }
    shared.Endpoints.push_back(&endpoint);
}

inline void Leave(RejoiningShared &shared, RejoiningEndpoint *endpoint)
{
    const std::lock_guard lock(shared.Structure);
    std::erase(shared.Endpoints, endpoint);
}

}  // namespace Rabit
