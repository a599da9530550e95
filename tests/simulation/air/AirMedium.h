#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "AirPacket.h"

namespace Rabit::Sim
{

// A shared half-duplex radio. Each node has a first-in-first-out queue that drops packets that do not fit.
// One packet at a time is on the air, and the nodes with a packet take turns. A packet that has begun keeps
// the rate at which it began.
class AirMedium
{
public:
    static constexpr std::size_t QueueBytes = 16'384;

    AirMedium(std::size_t nodes, double bitsPerSecond) : _queues(nodes), _bitsPerSecond(bitsPerSecond) {}

    void SetRate(double bitsPerSecond) { _bitsPerSecond = bitsPerSecond; }
    // Returns false if the queue dropped the packet.
    bool Offer(AirPacket packet, Time now);
    // Returns when the packet on the air arrives; empty if there is none.
    std::optional<Time> NextArrival() const;
    // Ends the packet on the air and returns it. The next one begins.
    AirPacket Arrive(Time now);
    // Returns how long the packet on the air waited in its queue.
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
