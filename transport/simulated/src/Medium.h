#pragma once

#include <rabit/simulated/SimulatedNetwork.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>

namespace Rabit::Simulated
{

struct Flight;

// What a node has given to a medium: one datagram.
struct Packet
{
    std::uint32_t Node = 0;   // that sends it
    std::uint64_t Bytes = 0;  // on the air
    std::shared_ptr<Flight> Content;
    std::chrono::nanoseconds At{0};  // when it was given
};

// A shared half-duplex medium: a queue for each node, first in first out, that drops what does not fit; one
// packet at a time is on the air, and the nodes that have something take turns. A pure state machine.
class Medium
{
public:
    void Set(const SimulatedMedium &settings) { _settings = settings; }
    // Whether a packet has to wait, or takes time.
    bool IsInTheWay() const { return _settings.BytesPerSecond > 0 || _onAir; }

    // False: the node's queue is full.
    bool Offer(Packet packet, std::chrono::nanoseconds now);
    // When the packet that is on the air has passed; empty: none is.
    std::optional<std::chrono::nanoseconds> Passes() const;
    // It has. The next one begins.
    Packet Pass(std::chrono::nanoseconds now);

    // In a node's queue.
    std::uint64_t WaitingBytes(std::uint32_t node) const;
    // So far.
    const SimulatedAir &Air() const { return _air; }

private:
    struct Queue
    {
        std::deque<Packet> Packets;
        std::uint64_t Bytes = 0;
    };

    void Begin(Packet packet, std::chrono::nanoseconds now);

    SimulatedMedium _settings;
    std::map<std::uint32_t, Queue> _queues;  // by node; those that have something
    std::optional<Packet> _onAir;
    std::chrono::nanoseconds _passes{0};
    SimulatedAir _air;
};

}  // namespace Rabit::Simulated
