#pragma once

#include <atomic>

namespace Rabit
{

// Bytes in a second that a session's discovery may take (TransportSession::SetDiscoveryRate), for whichever
// of the vendor's sessions there is now; 0: as much as it needs.
using DiscoveryRate = std::atomic<double>;

}  // namespace Rabit
