#pragma once

#include "Oracle.h"
#include "Packet.h"
#include "Scenario.h"

#include <DriftingClock.h>
#include <rabit/gateway/links/LinkNode.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit::Sim
{

// The world around a node, as the node uses it.
struct SimWorld
{
    const Scenario &Plan;
    Sim::Oracle &Oracle;
    SimRandom &Random;
    std::vector<DriftingClock> &LifeClocks;  // by life
    LinkTime Now{0};                         // true time
    std::function<void(Packet)> Transmit;
    // A queue of a node is no longer empty.
    std::function<void(std::size_t node, std::size_t queue)> QueueFilled;
    // The node's preparation of that index will be finished some time later.
    std::function<void(std::size_t node, std::size_t index)> Prepare;
};

// One node: a machine with a wall clock and perhaps a counter file, on which a process with a LinkNode and
// local queues runs and crashes.
class SimNode final : public LinkOutput, public LocalQueues, public IncarnationSource
{
public:
    SimNode(SimWorld &world, std::size_t index);

    bool IsAlive() const { return _links != nullptr; }
    LinkNode &Links() { return *_links; }
    LinkTime LocalNow() const { return _clock.At(_world.Now); }

    void Start(bool storageLost);
    void Crash();
    void StepWallClock(std::int64_t seconds) { _wallSeconds += seconds; }

    void Enqueue(std::size_t link);
    // Forgets another node, if nothing waits for it. Returns whether there was something to forget.
    bool Forget(std::size_t node);
    // Returns true if the node could decode the packet.
    bool Receive(const Packet &packet);
    // Receives the packet once more, malformed.
    void ReceiveSpoiled(const Packet &packet);
    // Takes a message out of a queue; local producers may put one in. Returns whether there are more.
    bool Consume(std::size_t queue);
    // Finishes a preparation, as a driver does when it has decoded a large message.
    void FinishPreparation(std::size_t index);
    // From now on no pop event is lost, the reported room is right, and there are no local producers.
    void SetCalm() { _calm = true; }

    // Checks what can be checked of this node alone, after an event.
    void Check();

    void Send(const LinkFrame &frame, std::string_view queue) override;
    void OnOutcome(std::uint64_t id, std::string_view destination, std::string_view queue,
                   LinkOutcome outcome) override;
    bool Accepts(std::string_view source, std::string_view queue) override;
    bool AcceptsType(std::string_view queue, std::string_view type) const override;
    LocalQueueResult Deliver(const LinkDelivery &delivery) override;
    std::size_t Room(std::string_view queue) const override;
    std::uint64_t Above(std::uint64_t floor) override;

private:
    // A large message that the driver decodes while the links go on.
    struct Preparation
    {
        std::string Source, Queue;
        std::uint64_t SenderLife = 0;
        std::uint64_t Number = 0;
        std::vector<std::uint8_t> Payload;
    };

    std::size_t NodeOf(std::string_view name) const;
    std::size_t QueueOf(std::string_view name) const;

    SimWorld &_world;
    const std::size_t _index;
    DriftingClock _clock;
    std::unique_ptr<LinkNode> _links;
    std::vector<std::size_t> _queueLengths;
    mutable std::vector<bool>
        _toldFull;  // by queue: the links were told of no room since they were told of room
    std::vector<Preparation> _preparations;  // of all processes of the node
    std::size_t _firstPreparation = 0;       // of the present one
    std::uint64_t _storedCounter = 0;
    std::int64_t _wallSeconds;
    bool _wasStarted = false;
    std::size_t _build = 0;  // of its program, with its own definition of a type
    bool _calm = false;
};

}  // namespace Rabit::Sim
