#pragma once

#include <atomic>

namespace Rabit
{

// Bytes per second that a session's discovery may take (TransportSession::SetDiscoveryRate); 0: unlimited.
// Shared by the successive vendor's sessions of one session.
using DiscoveryRate = std::atomic<double>;

}  // namespace Rabit
