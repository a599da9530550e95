#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "air/AirCost.h"
#include "gateway.idl.h"
#include "mirrors/TopicPublisher.h"

namespace Rabit
{

// What Gateway/Fleet says of the air: rates, from counters that rise. They are of about the last second:
// asked more often it says the same again. What was sent is what the transport has counted; how it divides
// among publications and links is computed from the sizes of what they wrote, and the rest is presence.
class AirReport
{
public:
    using Duration = std::chrono::nanoseconds;

    // The configuration must outlive the object.
    AirReport(const GatewayConfig &config, const AirCost &cost) : _config(config), _cost(cost) {}

    // Fills fleet.air, and the rates of its links and publications, which are there already, the latter in
    // the order of the publishers. Adds a problem for each publication whose newest value takes more than a
    // second of the budget. `capacity`: bytes a second that the air carries; empty: not limited by it.
    void Fill(const TransportCounters &counters, std::optional<double> capacity,
              const std::deque<TopicPublisher> &publishers, Gateway::Fleet &fleet, Duration now);

private:
    // Bytes in all that were sent, and how many a second lately.
    struct Rate
    {
        std::uint64_t Bytes = 0;
        double PerSecond = 0.0;
        bool Seen = true;

        void Look(std::uint64_t bytes, double seconds);
    };
    struct Publication
    {
        std::uint64_t Written = 0;
        Rate Sent;
    };

    void Measure(const TransportCounters &counters, const std::deque<TopicPublisher> &publishers,
                 const Gateway::Fleet &fleet, double seconds);

    const GatewayConfig &_config;
    const AirCost _cost;
    Duration _measuredAt{0};
    Rate _discovery;
    Rate _samples;
    std::vector<Publication> _publications;
    std::map<std::pair<std::string, std::string>, Rate> _links;  // node, queue
};

}  // namespace Rabit
