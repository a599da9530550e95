// A session that joins the network again when an address that it was opened with is gone and there is
// another.
//
// Neither vendor follows a change of addresses: what a participant announces of itself is fixed when it is
// made. So the backend's session is closed and opened again, with all its writers and readers, while those
// who hold them notice nothing but what Transport.h says of it.
#pragma once

#include <rabit/transport/Transport.h>

#include <functional>
#include <memory>

namespace Rabit
{

// Opens a session of the backend itself. Throws TransportError.
using OpenSession =
    std::function<std::unique_ptr<TransportSession>(const TransportSettings &settings, PeerHandler onPeer)>;

// Throws TransportError if the first opening fails.
std::unique_ptr<TransportSession> OpenRejoining(const TransportSettings &settings, PeerHandler onPeer,
                                                OpenSession open);

}  // namespace Rabit
