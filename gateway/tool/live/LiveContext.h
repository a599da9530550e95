#pragma once

#include <rabit/keys/TokenGuard.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "live/LiveProtocol.h"
#include "live/LiveQueue.h"
#include "live/LiveServer.h"

namespace Rabit::Tool
{

class LiveSession;

// Shared by the sessions of a LiveServer. For the server's thread, except the counters.
struct LiveContext
{
    struct Offered
    {
        LiveProtocol::Channel Channel;
        bool IsState = false;
        std::shared_ptr<const LiveValue> Last;  // of a State
    };

    LiveServer::Settings Settings;
    std::string SessionId;  // of this run of the server
    std::map<std::uint32_t, Offered> Channels;
    std::set<LiveSession *> Sessions;  // those with a viewer
    std::size_t Seats = 0;             // taken, by viewers and by those whose handshake is under way
    std::atomic<std::uint64_t> Viewers{0};
    std::atomic<std::uint64_t> Shown{0};
    std::atomic<std::uint64_t> Dropped{0};
    std::optional<Keys::TokenGuard> Guard{};  // empty: no token is needed
};

}  // namespace Rabit::Tool
