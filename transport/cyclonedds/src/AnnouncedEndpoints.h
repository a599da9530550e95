#pragma once

#include <cstdint>
#include <span>

namespace Rabit::Cyclone
{

// Removes from a Rabit node's announcement those of the vendor's builtin endpoints that neither side uses:
// for the liveliness of single writers and for descriptions of types. Each pair of nodes would announce,
// request and acknowledge them: half of the nodes' discovery traffic. Announcements of plain programs are
// unchanged, since these may use the endpoints. Works in place; returns true if an endpoint was removed.
bool LeaveOutIdleEndpoints(std::span<std::uint8_t> datagram);

}  // namespace Rabit::Cyclone
