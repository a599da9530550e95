#pragma once

#include <rabit/transport/Transport.h>

namespace Rabit
{

// True if samples for several readers, and discovery between nodes that know each other, go by multicast.
// Listed peers turn it off: multicast may not reach all of them.
inline bool IsMulticastForData(const TransportSettings &settings)
{
    return settings.Multicast && settings.Peers.empty();
}

}  // namespace Rabit
