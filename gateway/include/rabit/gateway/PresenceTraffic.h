#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <chrono>
#include <cstddef>

namespace Rabit
{

// The traffic of presence of one node while no node comes or goes and nothing is lost: beats, and the
// announcements of DDS discovery.
struct PresenceTraffic
{
    std::size_t BeatBytes = 0;              // of a beat to one destination, with all headers (AirCost.h)
    std::chrono::nanoseconds BeatPeriod{};  // from one beat to the next
    std::chrono::milliseconds AnnouncementPeriod{};  // of DDS discovery
};

// Returns the traffic of a gateway with that configuration. `copies`: destinations that a beat is sent to, 1
// by multicast. Looks at no network; any thread may call it.
PresenceTraffic PresenceTrafficOf(const GatewayConfig &config, std::size_t copies);

}  // namespace Rabit
