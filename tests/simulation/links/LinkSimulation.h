#pragma once

#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <ostream>
#include <string>

namespace Rabit::Sim
{

// Counts of events in a run, to see that the simulation tries what it is meant to try.
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
    std::uint64_t ThinMedia = 0;       // runs over a medium with a rate
    std::uint64_t RateChanges = 0;     // of such a medium
    std::uint64_t Overflows = 0;       // datagrams that a node's queue had no room for
    std::uint64_t LargeDelivered = 0;  // messages that came in several parts
    std::uint64_t PartsHeld = 0;       // parts that a receiver held beyond a gap or for want of room
    std::uint64_t Prepared = 0;        // large messages that a driver decoded while the links went on
    std::uint64_t GivenUp = 0;         // in doubt since they expired while the receiver was silent
    std::uint64_t BytesSent = 0;
    std::uint64_t PayloadDelivered = 0;
    std::uint64_t Crashes = 0;
    std::uint64_t StoragesLost = 0;
    std::uint64_t Forgotten = 0;  // peers that a node forgot while it lived
    std::uint64_t Raises = 0;     // incarnations taken because a peer knew a higher one
    std::uint64_t MostSent = 0;   // percent of the bytes that are enough
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
