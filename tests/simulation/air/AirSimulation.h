#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "AirPacket.h"
#include "AirScenario.h"

namespace Rabit::Sim
{

// The traffic on the air in one second.
struct AirSecond
{
    double Use = 0.0;     // of what the radio could carry
    Time LongestWait{0};  // in a node's queue, of what was sent in it
    std::uint64_t Bytes = 0;
    std::uint64_t Packets = 0;
    std::uint64_t Late = 0;  // of them: waited for 300 ms or longer
};

struct AirResult
{
    // Measured from Settled on.
    double Use = 0.0;
    std::vector<std::uint64_t> BytesOf;  // by node
    std::vector<Time> Waits;             // in a node's queue, ascending
    std::vector<Time> CommandWaits;      // from ready to heard, ascending
    // The most bytes of one node in any second, on the air.
    std::uint64_t MostInASecond = 0;
    std::uint64_t Packets = 0;
    std::vector<AirSecond> Seconds;  // from the beginning
    // Of node 0, which may be deaf; empty: unlimited.
    std::optional<double> RateWhenDeaf;
    std::optional<double> RateAtEnd;

    static Time Quantile(const std::vector<Time> &ascending, double share);
};

AirResult RunAir(const AirScenario &scenario, std::ostream *trace = nullptr);

// The scenario of a seed, and the broken promise of the schedule or the estimate; empty if none was broken.
AirScenario ScenarioOf(std::uint64_t seed);
std::string Judge(const AirScenario &scenario, const AirResult &result);

}  // namespace Rabit::Sim
