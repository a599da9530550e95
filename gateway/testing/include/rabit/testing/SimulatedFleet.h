#pragma once

#include <rabit/ManualClock.h>
#include <rabit/RabitLog.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/simulated/SimulatedKeys.h>
#include <rabit/simulated/SimulatedTransport.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

namespace Rabit
{

// A manager that does nothing but own a queue: a test takes from it what others send.
class IdleManager : public RabitManager
{
public:
    using RabitManager::RabitManager;
    void ExecuteUnitOfWork() final { ++Passes; }
    int Passes = 0;
};

// One node of a simulated fleet: a workspace with a clock of its own, managers, and a gateway.
class SimulatedNode
{
public:
    // Adds the program's managers to node.Reactor, with node.Workspace, and may complete the gateway's
    // configuration. The gateway is added after them, as by RunNode.
    using AddFirst = std::function<void(SimulatedNode &node, GatewayConfig &config)>;

    // The monotonic clock is ahead of the network's by `monotonic`; the wall clock shows `gps` at the start.
    SimulatedNode(GatewayConfig config, SimulatedNetwork &network, std::chrono::nanoseconds monotonic,
                  double gps, const AddFirst &addFirst = {})
        : Ahead(monotonic),
          Clock(std::make_shared<ManualClock>(gps, network.Now() + monotonic)),
          Workspace(Clock),
          Reactor(Workspace)
    {
        if (addFirst)
        {
            addFirst(*this, config);
        }
        auto gateway = std::make_unique<GatewayManager>(
            config, std::make_shared<SimulatedTransport>(network), Workspace,
            [engine = std::mt19937_64(static_cast<std::uint64_t>(monotonic.count()))]() mutable
            { return engine(); });
        Manager = gateway.get();
        Reactor.AddManager(std::move(gateway));
    }

    IdleManager &AddIdleManager(const std::string &name)
    {
        auto manager = std::make_unique<IdleManager>(name, Workspace);
        IdleManager &added = *manager;
        Reactor.AddManager(std::move(manager));
        return added;
    }

    // Registers a local copy of a message under this name, and returns it. Throws std::invalid_argument if
    // the name has a message of another type.
    template <typename Message>
    std::shared_ptr<Message> Register(const std::string &name)
    {
        auto message = std::make_shared<Message>();
        if (!Workspace.AddPublishSubscribeMessage(name, message))
        {
            throw std::invalid_argument("the message " + name + " is of another type");
        }
        return message;
    }

    // Returns the newest contents of a message; a default one if nothing was posted.
    template <typename Message>
    Message Newest(const std::string &name)
    {
        Message message;
        Workspace.ForceFetchMessage(name, &message);
        return message;
    }

    // Returns the newest contents of Gateway/Fleet.
    Gateway::Fleet Fleet() { return Newest<Gateway::Fleet>(FleetMessageName); }

    // Returns `UP`, `STALE` or `LOST`; empty if the node is not listed.
    std::string StateOf(const std::string &node)
    {
        const Gateway::Fleet fleet = Fleet();
        const Gateway::NodeStatus *status = Gateway::FindNode(fleet, node);
        return status == nullptr ? "" : ToString(status->state);
    }

    // Returns the counters of the link to this queue; zeros if there are none.
    Gateway::LinkStatus LinkTo(const std::string &node, const std::string &queue)
    {
        for (const Gateway::LinkStatus &link : Fleet().links)
        {
            if (link.node == node && link.queue == queue)
            {
                return link;
            }
        }
        return {};
    }

    // Returns "subject: reason" of every problem, one to a line.
    std::string Problems()
    {
        std::string text;
        for (const Gateway::Problem &problem : Fleet().problems)
        {
            text += problem.subject + ": " + problem.reason + "\n";
        }
        return text;
    }

    std::chrono::nanoseconds Ahead;  // of the network's clock
    const std::shared_ptr<ManualClock> Clock;
    RabitWorkspace Workspace;
    RabitSteppedReactor Reactor;
    GatewayManager *Manager = nullptr;
};

// Nodes in one process, on a simulated network, under simulated time: the tests of a fleet run in
// milliseconds, and the seed decides everything that happens, so a failure happens again. Managers run on the
// calling thread, in a fixed order, and take no time.
//
//     Rabit::SimulatedFleet fleet;
//     fleet.Add(Rabit::LoadGatewayConfig("uav.yaml", "uav1"), [](Rabit::SimulatedNode &node,
//     Rabit::GatewayConfig &)
//               { node.Reactor.AddManager(std::make_unique<Pilot>(node.Workspace)); });
//     Rabit::SimulatedNode &ground = fleet.Add(groundConfig);
//     fleet.Network.SetFaults("*", "*", {.Loss = 0.2});
//     fleet.RunFor(10s);
//     EXPECT_EQ(ground.StateOf("uav1"), "UP");
//     EXPECT_LT(ground.Newest<Uav::Pose>("uav1/Pose").GetAgeSeconds(*ground.Clock), 1);
//     fleet.Kill("uav1");
//
// Not thread-safe. Faults, counters and the air are SimulatedNetwork's.
class SimulatedFleet
{
public:
    explicit SimulatedFleet(std::uint64_t seed = 1, const SimulatedTimings &timings = {})
        : Network(seed, timings)
    {
    }

    // Adds and starts a node with its managers.
    SimulatedNode &Add(const GatewayConfig &config, const SimulatedNode::AddFirst &addManagers)
    {
        return Add(config, 1.4e9, "", addManagers);
    }
    // The same, with the wall clock of the node (GPS seconds). No two nodes' monotonic clocks agree. A second
    // node of one name needs a key of its own, under which the functions below know it.
    SimulatedNode &Add(const GatewayConfig &config, double gps = 1.4e9, const std::string &key = "",
                       const SimulatedNode::AddFirst &addFirst = {})
    {
        _ahead += std::chrono::seconds(1000);
        GatewayConfig own = config;
        if (_keys && !(own.Security && own.Security->Member))
        {
            own.Security.emplace().Member = _keys->Member(own.Node);
            for (PathRule &path : own.Paths)
            {
                path.Security.reset();
            }
        }
        auto node = std::make_unique<SimulatedNode>(std::move(own), Network, _ahead, gps, addFirst);
        SimulatedNode &added = *node;
        _nodes[key.empty() ? config.Node : key] = std::move(node);
        added.Reactor.Start();
        return added;
    }

    // Nodes that are added from now on are members of one fleet with keys, in place of the folder of keys in
    // their configuration; with `false` they are not. Nodes with keys and nodes without do not hear each
    // other.
    void FlyWithKeys(bool withKeys = true)
    {
        _keys = withKeys ? std::make_unique<SimulatedKeys>(Network) : nullptr;
    }

    SimulatedNode &operator[](const std::string &node) { return *_nodes.at(node); }

    // Ends a node as SIGKILL would: it says nothing more, neither to the others nor to the log. Its managers'
    // destructors run.
    void Kill(const std::string &node)
    {
        Network.CrashNode(node);
        const RabitLogLevel level = RabitLog::GetLevel();
        RabitLog::SetLevel(RabitLogLevel::Off);
        _nodes.erase(node);
        RabitLog::SetLevel(level);
    }

    // Ends a node in an orderly way.
    void Stop(const std::string &node) { _nodes.erase(node); }

    // Stops a node for `duration` while the others run on, like a virtual machine that is paused. Its
    // monotonic clock does not advance, and incoming samples wait.
    void StandStill(const std::string &node, std::chrono::nanoseconds duration)
    {
        auto still = std::move(_nodes.at(node));
        _nodes.erase(node);
        RunFor(duration);
        still->Ahead -= duration;
        _nodes[node] = std::move(still);
    }

    // Lets that much time pass for all.
    void RunFor(std::chrono::nanoseconds duration)
    {
        RunUntil([] { return false; }, duration);
    }

    // Runs until the condition holds; returns whether it did within the limit.
    bool RunUntil(const std::function<bool()> &condition, std::chrono::nanoseconds limit)
    {
        const std::chrono::nanoseconds end = Network.Now() + limit;
        RunDue();
        while (!condition())
        {
            const std::chrono::nanoseconds next = NextDue();
            if (next > end)
            {
                Advance(end);
                return condition();
            }
            Advance(next);
        }
        return true;
    }

    SimulatedNetwork Network;

private:
    std::chrono::nanoseconds NextDue() const
    {
        std::chrono::nanoseconds next = Network.NextEvent().value_or(std::chrono::nanoseconds::max());
        for (const auto &[name, node] : _nodes)
        {
            if (const auto due = node->Reactor.NextDue())
            {
                next = std::min(next, *due - node->Ahead);
            }
        }
        return next;
    }

    void Advance(std::chrono::nanoseconds time)
    {
        // Advances the nodes' clocks first: handlers that the network calls read them.
        for (const auto &[name, node] : _nodes)
        {
            node->Clock->AdvanceTo(time + node->Ahead);
        }
        Network.AdvanceTo(time);
        RunDue();
    }

    void RunDue()
    {
        for (const auto &[name, node] : _nodes)
        {
            node->Reactor.RunDue();
        }
    }

    std::chrono::nanoseconds _ahead{0};
    std::unique_ptr<SimulatedKeys> _keys;  // null: nodes have none
    std::map<std::string, std::unique_ptr<SimulatedNode>> _nodes;
};

}  // namespace Rabit
