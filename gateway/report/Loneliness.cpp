#include "report/Loneliness.h"

#include <algorithm>
#include <string>
#include <vector>

namespace Rabit::Loneliness
{
namespace
{

std::string Listed(const std::vector<std::string> &items, const std::string &none)
{
    constexpr std::size_t most = 6;
    std::string text;
    for (std::size_t i = 0; i < items.size() && i < most; ++i)
    {
        text += (i > 0 ? ", " : "") + items[i];
    }
    if (items.size() > most)
    {
        text += " and " + std::to_string(items.size() - most) + " more";
    }
    return items.empty() ? none : text;
}

// Sent bytes are not counted if the vendor's own settings (BackendConfig) may have replaced the transport.
std::string WhatGoesOut(const GatewayConfig &config, const TransportCounters &counters)
{
    if (config.BackendConfig.empty() && counters.DiscoveryBytes == 0)
    {
        return "nothing goes out";
    }
    if (!config.Multicast)
    {
        return "multicast is off";
    }
    return config.BackendConfig.empty() ? "multicast goes out" : "multicast is on";
}

// Over shared memory, participants of one host do not use UDP between them.
std::string WhatSharedMemoryNeeds(const GatewayConfig &config)
{
    return config.SharedMemory ? "; shared_memory is on, so a node of this host is heard only if both have "
                                 "the same user and the same /dev/shm"
                               : "";
}

std::string WhatKeysNeed(const GatewayConfig &config)
{
    return SomePathHasKeys(config) ? "; with keys, only nodes of the same fleet are heard" : "";
}

// True if foreign programs may be all that the node is there for.
bool IsForPrograms(const GatewayConfig &config)
{
    return !config.Foreign.empty() && config.Subscribe.empty() && config.Send.empty();
}

}  // namespace

bool HearsPrograms(const TransportSession &session)
{
    const std::vector<std::string> topics = session.RemoteTopics();
    return std::any_of(topics.begin(), topics.end(),
                       [&session](const std::string &topic)
                       {
                           const std::vector<RemoteEndpoint> others = session.RemoteEndpointsOn(topic);
                           return std::any_of(others.begin(), others.end(),
                                              [](const RemoteEndpoint &other) { return other.Node.empty(); });
                       });
}

std::optional<Gateway::Problem> Look(const GatewayConfig &config, const PeersOverPaths &peers,
                                     const TransportCounters &counters,
                                     const std::function<bool()> &hearsPrograms,
                                     std::chrono::nanoseconds openedAt, std::chrono::nanoseconds now)
{
    std::chrono::nanoseconds last = openedAt;
    for (const PeerTable::Peer *peer : peers.Heard())
    {
        if (peer->State != Gateway::NodeState::LOST)
        {
            return std::nullopt;
        }
        last = std::max(last, peer->LastHeard);
    }
    if (now - last < Patience)
    {
        return std::nullopt;
    }
    const bool arePrograms = hearsPrograms();
    if (arePrograms && IsForPrograms(config))
    {
        return std::nullopt;
    }
    return Gateway::Problem{
        "network", "",
        std::string(arePrograms ? "only programs that are no nodes" : "nobody") + " heard in domain " +
            std::to_string(config.Domain) + " on " + Listed(config.Interfaces, "all interfaces") + " for " +
            std::to_string(std::chrono::duration_cast<std::chrono::seconds>(Patience).count()) + " s; " +
            WhatGoesOut(config, counters) + "; peers: " + Listed(config.Peers, "none") +
            WhatSharedMemoryNeeds(config) + WhatKeysNeed(config) + " (docs/how_to/connect.md)",
        true};
}

}  // namespace Rabit::Loneliness
