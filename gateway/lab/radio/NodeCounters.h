#pragma once

#include "Frame.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>

namespace Rabit::Radio
{

// Time since the medium's beginning: the medium has no clock of its own.
using Time = std::chrono::nanoseconds;

struct Count
{
    std::uint64_t Frames = 0;
    std::uint64_t Bytes = 0;

    void Add(std::size_t bytes)
    {
        ++Frames;
        Bytes += bytes;
    }
};

// The most bytes within any second, wherever it begins, so that a budget can be judged "in every second". A
// frame counts as a whole at the end of its time on the air.
class SecondWindow
{
public:
    // Times do not go back.
    void Add(Time at, std::size_t bytes);
    std::uint64_t Most() const { return _most; }

private:
    std::deque<std::pair<Time, std::size_t>> _last;  // younger than a second before the newest
    std::uint64_t _sum = 0;
    std::uint64_t _most = 0;
};

// Counters of the frames that one node has sent and heard. Bytes are whole frames; on the air, the medium's
// overhead is included. Members named Ip count IP packets with their headers, as budgets do.
struct NodeCounters
{
    Count Offered;               // what the node gave to its queue
    Count Dropped;               // of it: the queue was full
    Count Multicast;             // on the air, one for all receivers
    Count Unicast;               // on the air
    Count Heard;                 // of others
    std::uint64_t IpSent = 0;    // on the air, bytes
    std::uint64_t Lost = 0;      // would have been heard and were lost at random
    std::uint64_t Missed = 0;    // would have been heard but for deafness or an outage
    std::uint64_t Collided = 0;  // would have been heard but for another frame at the same time
    std::uint64_t Nobody = 0;    // on the air for an address that no node has
    Time LongestWait{0};         // in the queue, of what was sent
    SecondWindow AirSecond;
    SecondWindow IpSecond;
    // Counts by kind of the frames on the air. At most MostKinds kinds; the rest is under a Kind of zeros.
    std::map<Kind, Count> Kinds;

    static constexpr std::size_t MostKinds = 256;
    void OnAir(Time at, const Frame &frame, std::size_t overhead, Time waited);
};

}  // namespace Rabit::Radio
