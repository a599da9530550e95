#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "AirPacket.h"
#include "wire/BeatFormat.h"

namespace Rabit::Sim
{

// The actions of several nodes on one radio.
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
    // The rate that all nodes together want to send, in multiples of the radio's rate; more than half of it
    // bulk.
    double Offered = 10.0;
    std::size_t Senders = static_cast<std::size_t>(-1);  // how many want to send bulk, the first ones
    // Time between commands of a node, on average.
    Time Commands = std::chrono::milliseconds(400);
    Time Beats = std::chrono::milliseconds(500);
    bool Acknowledged = true;  // bulk goes to the last node, which says every 250 ms what came
    // A beat or an acknowledgement reports on BeatFormat::MostDelays nodes at most, which take turns.
    // Without, it reports on all nodes that were heard.
    bool ReportsTakeTurns = false;
    // Share of packets lost, at each receiver.
    double Loss = 0.0;
    // From then on node 0 hears nothing of the other nodes.
    Time DeafAt = Time::max();

    Time Settled = std::chrono::seconds(30);  // measured from then on
    Time Ends = std::chrono::seconds(90);
    std::uint64_t Seed = 1;

    // Reports in a beat or an acknowledgement, at most, and its bytes.
    std::size_t MostReports() const { return ReportsTakeTurns ? BeatFormat::MostDelays : Nodes; }
    std::size_t ReportBytes() const { return 90 + 8 * MostReports(); }
};

}  // namespace Rabit::Sim
