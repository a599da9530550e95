#pragma once

#include <rabit/transport/Transport.h>

#include <memory>

#include "common/SendingTurn.h"
#include "common/SessionLog.h"
#include "common/TopicRegistry.h"

namespace Rabit
{

// State that a RejoiningSession shares with the sessions of the backend that it opens one after the other.
struct SessionContext
{
    std::shared_ptr<SessionLog> Log;
    std::shared_ptr<TopicRegistry> Topics;
    PeerHandler OnPeer;  // never empty
    std::shared_ptr<DiscoveryTurns> Turns;
    std::shared_ptr<SendingTurn> Sending;
};

}  // namespace Rabit
