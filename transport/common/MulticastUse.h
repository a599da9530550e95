#pragma once

#include <rabit/transport/Transport.h>

namespace Rabit
{

// Whether samples, and discovery between those who know each other, go by multicast where several want them.
// Peers are listed where multicast does not pass, or not to all of them.
inline bool IsMulticastForData(const TransportSettings &settings)
{
    return settings.Multicast && settings.Peers.empty();
}

}  // namespace Rabit
