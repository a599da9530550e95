#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "AirPacket.h"

namespace Rabit::Sim
{

// A shared half-duplex radio: each node has a queue, first in first out, that drops what does not fit; one
// packet at a time is on the air, and the nodes that have something take turns. A packet that has begun keeps
// the rate at which it began.
class AirMedium
{
public:
    static constexpr std::size_t QueueBytes = 16'384;

    AirMedium(std::size_t nodes, double bitsPerSecond) : _queues(nodes), _bitsPerSecond(bitsPerSecond) {}

    void SetRate(double bitsPerSecond) { _bitsPerSecond = bitsPerSecond; }
    // False: dropped.
    bool Offer(AirPacket packet, Time now);
    // When the packet that is on the air has come; empty: none is.
    std::optional<Time> NextArrival() const;
    // It has. The next one begins.
    AirPacket Arrive(Time now);
    // How long the packet on the air has waited.
    Time Waited() const { return _began - _air->SentAt; }

private:
    struct Queue
    {
        std::deque<AirPacket> Packets;
        std::size_t Bytes = 0;
    };

    void Begin(Time now);

    std::vector<Queue> _queues;
    double _bitsPerSecond;
    std::optional<AirPacket> _air;
    Time _began{0};
    Time _ends{0};
    std::size_t _turn = 0;
};

}  // namespace Rabit::Sim
