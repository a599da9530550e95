#pragma once

#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <ostream>
#include <string>

namespace Rabit::Sim
{

// What happened in a run: to see that the simulation tries what it is meant to try.
struct SimStatistics
{
    std::uint64_t Events = 0;
    std::uint64_t Accepted = 0;
    std::uint64_t Refused = 0;
    std::uint64_t Delivered = 0;  // outcomes, as the four below
    std::uint64_t Expired = 0;
    std::uint64_t InDoubt = 0;
    std::uint64_t RefusedThere = 0;
    std::uint64_t DeliveredAgain = 0;  // redelivered, and delivered before
    std::uint64_t Datagrams = 0;
    std::uint64_t Lost = 0;
    std::uint64_t Duplicated = 0;
    std::uint64_t Straggling = 0;
    std::uint64_t Malformed = 0;
    std::uint64_t Crashes = 0;
    std::uint64_t StoragesLost = 0;
    std::uint64_t Forgotten = 0;  // peers that a node forgot while it lived
    std::uint64_t Raises = 0;     // incarnations taken because a peer knew a higher one
    LinkTime LongestDrain{0};
};

struct SimResult
{
    std::string Failure;  // empty: all invariants held
    SimStatistics Statistics;
};

// Runs the scenario of one seed to its end, or to the first violation. With a trace, each event is written to
// it; the run is the same.
SimResult RunSeed(std::uint64_t seed, std::ostream *trace);

}  // namespace Rabit::Sim
