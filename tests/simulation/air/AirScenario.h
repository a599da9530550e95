#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "AirPacket.h"

namespace Rabit::Sim
{

// What several nodes do on one radio.
struct AirScenario
{
    std::size_t Nodes = 2;
    double BitsPerSecond = 250e3;
    // From FallsAt until ReturnsAt the radio carries FallsTo.
    double FallsTo = 0.0;
    Time FallsAt = Time::max();
    Time ReturnsAt = Time::max();

    // Bytes a second of each node; empty: by CapacityEstimate.
    std::optional<double> Budget{};
    // Of the radio's rate, what all nodes together want to send; more than half of it bulk.
    double Offered = 10.0;
    std::size_t Senders = static_cast<std::size_t>(-1);  // how many want to send bulk, the first ones
    // Time between commands of a node, on average.
    Time Commands = std::chrono::milliseconds(400);
    Time Beats = std::chrono::milliseconds(500);
    bool Acknowledged = true;  // bulk goes to the last node, which says every 100 ms what came
    // Packets that do not come, at each receiver.
    double Loss = 0.0;
    // From then on nothing of the other nodes comes to node 0.
    Time DeafAt = Time::max();

    Time Settled = std::chrono::seconds(30);  // measured from then on
    Time Ends = std::chrono::seconds(90);
    std::uint64_t Seed = 1;
};

}  // namespace Rabit::Sim
