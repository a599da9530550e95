#pragma once

#include <rabit/gateway/AirCost.h>
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

#include "gateway.idl.h"
#include "mirrors/TopicPublisher.h"

namespace Rabit
{

// Fills the part of Gateway/Fleet about the air: rates over about the last second, from rising counters. If
// called more often, it gives the same rates again. The bytes sent are those that the transport has counted.
// The shares of publications, links and foreign topics are those that were counted for them, or else computed
// from the sizes of their samples. The rest is presence.
class AirReport
{
public:
    using Duration = std::chrono::nanoseconds;

    // The configuration must outlive the object.
    AirReport(const GatewayConfig &config, const AirCost &cost) : _config(config), _cost(cost) {}

    // Bytes on the air since the beginning.
    struct Sent
    {
        std::uint64_t Foreign = 0;                     // of the foreign topics
        std::vector<std::uint64_t> Publications = {};  // in their order; empty: not known
    };

    // Of the path to the nodes that `carries` tells. Returns its part of fleet.air. Fills in the rates of the
    // links to these nodes. Adds to the rates of the publications, which are there already, in the order of
    // the publishers. Adds a problem for each publication whose newest value takes more than a second of the
    // budget, or of the capacity. `capacity`: estimated capacity of the channel in bytes a second; empty: it
    // does not limit this node.
    Gateway::AirStatus Fill(const TransportCounters &counters, std::optional<double> capacity,
                            const std::deque<TopicPublisher> &publishers, const Sent &sent,
                            const std::function<bool(std::string_view node)> &carries, Gateway::Fleet &fleet,
                            Duration now);

    // The members of the status in their order, as whole numbers with blanks between.
    static std::string TextOf(const Gateway::AirStatus &air);

private:
    // All bytes sent, and the rate of late.
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
                 const Sent &sent, const Gateway::Fleet &fleet, double seconds);

    const GatewayConfig &_config;
    const AirCost _cost;
    Duration _measuredAt{0};
    Rate _discovery;
    Rate _samples;
    Rate _foreign;
    std::vector<Publication> _publications;
    std::map<std::pair<std::string, std::string>, Rate> _links;  // node, queue
};

}  // namespace Rabit
