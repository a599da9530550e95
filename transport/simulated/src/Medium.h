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

// A datagram that a node has given to a medium.
struct Packet
{
    std::uint32_t Node = 0;   // the sender
    std::uint64_t Bytes = 0;  // on the air
    std::shared_ptr<Flight> Content;
    std::chrono::nanoseconds At{0};  // when it was given to the medium
};

// A shared half-duplex medium: a first-in first-out queue for each node, which drops packets that do not fit.
// One packet at a time is on the air, and nodes with packets take turns. A pure state machine.
class Medium
{
public:
    void Set(const SimulatedMedium &settings) { _settings = settings; }
    // True if a packet has to wait, or takes time.
    bool IsInTheWay() const { return _settings.BytesPerSecond > 0 || _onAir; }

    // Returns false if the node's queue is full.
    bool Offer(Packet packet, std::chrono::nanoseconds now);
    // When the packet on the air has passed; empty: there is none.
    std::optional<std::chrono::nanoseconds> Passes() const;
    // Takes the packet that has passed, and begins the next one.
    Packet Pass(std::chrono::nanoseconds now);

    // Bytes in a node's queue.
    std::uint64_t WaitingBytes(std::uint32_t node) const;
    // Statistics since the creation.
    const SimulatedAir &Air() const { return _air; }

private:
    struct Queue
    {
        std::deque<Packet> Packets;
        std::uint64_t Bytes = 0;
    };

    void Begin(Packet packet, std::chrono::nanoseconds now);

    SimulatedMedium _settings;
    std::map<std::uint32_t, Queue> _queues;  // by node; only nodes with packets
    std::optional<Packet> _onAir;
    std::chrono::nanoseconds _passes{0};
    SimulatedAir _air;
};

}  // namespace Rabit::Simulated
