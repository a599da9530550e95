#pragma once

#include <rabit/transport/Transport.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "common/RejoiningBackend.h"
#include "common/SessionLog.h"
#include "common/TopicRegistry.h"
#include "common/UseGate.h"

namespace Rabit
{

// A writer or reader that can be made anew in another session of the backend.
class RejoiningEndpoint
{
public:
    virtual void Open(BackendSession &session) = 0;
    virtual void Close() = 0;

protected:
    ~RejoiningEndpoint() = default;
};

// State that the session shares with its writers and readers.
struct RejoiningShared
{
    explicit RejoiningShared(const TransportSettings &settings)
        : Log(std::make_shared<SessionLog>(settings)), Topics(std::make_shared<TopicRegistry>(Log))
    {
    }

    const std::shared_ptr<SessionLog> Log;
    // Refuses an impossible topic even while there is no session of the backend.
    const std::shared_ptr<TopicRegistry> Topics;
    UseGate Gate;                           // guards the backend's objects that the endpoints hold
    std::mutex Structure;                   // guards the session and the list; taken before Gate
    std::unique_ptr<BackendSession> Inner;  // nullptr while not joined; guarded by Structure
    std::atomic<std::uint64_t> Left{0};     // times that a session was closed to join anew; guarded by Gate
    std::vector<RejoiningEndpoint *> Endpoints;  // guarded by Structure
};

// Adds the endpoint to the list, and opens it if there is a session.
inline void Enter(RejoiningShared &shared, RejoiningEndpoint &endpoint)
{
    const std::lock_guard lock(shared.Structure);
    if (shared.Inner != nullptr)
    {
        endpoint.Open(*shared.Inner);
    }
    shared.Endpoints.push_back(&endpoint);
}

// Removes the endpoint from the list and closes it, before the session can.
inline void Leave(RejoiningShared &shared, RejoiningEndpoint &endpoint)
{
    const std::lock_guard lock(shared.Structure);
    std::erase(shared.Endpoints, &endpoint);
    endpoint.Close();
}

}  // namespace Rabit
