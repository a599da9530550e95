// Two nodes with all their threads over a real backend, on loopback: effects that the simulation cannot
// show.
#include <gtest/gtest.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../Eventually.h"
#include "BackendPairs.h"
#include "DomainLease.h"
#include "gateway.idl.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Queue = RabitMessageQueue<std::shared_ptr<RabitMessage>>;

constexpr int Messages = 3000;

// Lets a test wait for what managers do on their threads.
class Condition
{
public:
    template <typename Change>
    void Set(Change change)
    {
        const std::lock_guard lock(_mutex);
        change();
        _changed.notify_all();
    }

    template <typename Holds>
    bool Wait(Holds holds)
    {
        std::unique_lock lock(_mutex);
        return _changed.wait_for(lock, RabitTest::Hangs, holds);
    }

private:
    std::mutex _mutex;
    std::condition_variable _changed;
};

// Sends numbered Gotos to the other node's manager of the same kind and posts a Pose with each. Checks that
// the other manager's are complete and in order.
class TrafficManager : public RabitManager
{
public:
    TrafficManager(RabitWorkspace &workspace, std::string other, Condition &condition)
        : RabitManager("Traffic", workspace),
          _address(other + "/Traffic"),
          _pose(std::make_shared<Uav::Pose>()),
          _otherPose(std::make_shared<Uav::Pose>()),
          _condition(condition)
    {
        AddPublishSubscribeMessage("Pose", _pose);
        AddPublishSubscribeMessage(other + "/Pose", _otherPose);
        WakeUpManagerOnMessagePost(_otherPose);
        SetWakeupTimeDelayMSec(1);
    }

    void ExecuteUnitOfWork() final
    {
        Receive();
        while (_sent < Messages)
        {
            auto message = std::make_shared<Uav::Goto>();
            message->id = static_cast<std::uint32_t>(_sent + 1);
            if (!AddMessageToQueue(_address, message))
            {
                break;  // not announced yet, or the outbox is full: again in the next unit of work
            }
            ++_sent;
            _pose->gps_time_s = _sent;
            _pose->PostMessage();
        }
        if (_otherPose->FetchMessage())
        {
            EXPECT_GE(_otherPose->gps_time_s, _lastPose) << "an older value came after a newer one";
            _lastPose = _otherPose->gps_time_s;
            EXPECT_LT(_otherPose->GetAgeSeconds(), 120.0);
        }
        _condition.Set(
            [this]
            {
                Received = _received;
                LastPose = _lastPose;
            });
    }

    // Guarded by the condition.
    int Received = 0;
    double LastPose = 0;

private:
    void Receive()
    {
        std::shared_ptr<RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            const auto command = std::dynamic_pointer_cast<Uav::Goto>(message);
            ASSERT_NE(command, nullptr);
            EXPECT_EQ(command->id, static_cast<std::uint32_t>(_received + 1));
            ++_received;
        }
    }

    const std::string _address;
    std::shared_ptr<Uav::Pose> _pose;
    std::shared_ptr<Uav::Pose> _otherPose;
    Condition &_condition;
    int _sent = 0;
    int _received = 0;
    double _lastPose = 0;
};

// The backends of the two nodes.
class RealNodesTest : public ::testing::TestWithParam<std::pair<std::string, std::string>>
{
protected:
    struct Node
    {
        Node(const std::string &transport, const std::string &name, const std::string &other,
             Condition &condition, const std::vector<std::string> &alsoAccepted = {})
            : Reactor(Workspace)
        {
            GatewayConfig config;
            config.Node = name;
            config.Domain = Conformance::OwnDomain();
            config.Interfaces = {"127.0.0.1"};
            config.Publish.push_back({.Message = "Pose", .Type = "Uav::Pose"});
            config.Subscribe.push_back({.Message = "Pose", .Type = "Uav::Pose"});
            config.Accept.push_back({.Queue = "Traffic", .Types = {"Uav::Goto"}});
            for (const std::string &queue : alsoAccepted)
            {
                config.Accept.push_back({.Queue = queue, .Types = {"Uav::Goto"}});
            }
            Reactor.SetHandleSignals(false);
            auto traffic = std::make_unique<TrafficManager>(Workspace, other, condition);
            Traffic = traffic.get();
            Reactor.AddManager(std::move(traffic));
            Reactor.AddManager(std::make_unique<GatewayManager>(config, MakeTransport(transport), Workspace));
            Thread = std::thread([this] { Reactor.Run(); });
        }

        ~Node()
        {
            Reactor.ShutdownAllManagers();
            Thread.join();
        }

        RabitWorkspace Workspace;
        RabitReactor Reactor;
        TrafficManager *Traffic = nullptr;
        std::thread Thread;
    };

    Condition condition;
};

TEST_P(RealNodesTest, QueuesAreCompleteAndInOrderAndTheLastPostArrivesUnderLoadBothWays)
{
    Node first(GetParam().first, "first", "second", condition);
    Node second(GetParam().second, "second", "first", condition);
    EXPECT_TRUE(condition.Wait(
        [&]
        {
            return first.Traffic->Received == Messages && second.Traffic->Received == Messages &&
                   first.Traffic->LastPose == Messages && second.Traffic->LastPose == Messages;
        }))
        << "received " << first.Traffic->Received << " and " << second.Traffic->Received << ", last pose "
        << first.Traffic->LastPose << " and " << second.Traffic->LastPose;
    for (Node *node : {&first, &second})
    {
        Gateway::Fleet fleet;
        node->Workspace.ForceFetchMessage(FleetMessageName, &fleet);
        EXPECT_EQ(fleet.malformed, 0u) << "nobody was taken for another one, nor nothing honest dropped";
    }
}

// A manager may end at any time, even while the transport's thread tells its queue of a message.
TEST_P(RealNodesTest, AQueueWhoseManagerGoesLivesUntilItsHandlersHaveRun)
{
    Node first(GetParam().first, "first", "second", condition, {"Passing"});
    Node second(GetParam().second, "second", "first", condition);
    const auto next = std::make_shared<Queue>(100, "Passing");
    auto going = std::make_shared<Queue>(100, "Passing");
    const std::weak_ptr<Queue> watched = going;
    bool called = false;
    bool alive = false;
    going->Register_SomethingEnqueued(
        [&, replaced = false]() mutable
        {
            if (std::exchange(replaced, true))
            {
                return;
            }
            // Waits until the workspace and the gateway's thread have released the queue.
            const long others = watched.use_count() - 2;
            first.Workspace.AddManagerMessageQueue("Passing", next);
            RabitTest::Eventually([&] { return watched.use_count() <= others; });
            condition.Set(
                [&]
                {
                    called = true;
                    alive = !watched.expired();
                });
        });
    first.Workspace.AddManagerMessageQueue("Passing", going);
    going.reset();
    while (!second.Workspace.AddMessageToQueue("first/Passing", std::make_shared<Uav::Goto>()))
    {
        std::this_thread::yield();  // not announced yet
    }
    ASSERT_TRUE(condition.Wait([&] { return called; }));
    EXPECT_TRUE(alive);
}

// The transport receives both messages on one thread.
TEST_P(RealNodesTest, ASlowHandlerDoesNotHoldUpWhatComesNext)
{
    bool began = false;  // these outlive the nodes, whose threads use them
    bool mayReturn = false;
    bool came = false;
    Node first(GetParam().first, "first", "second", condition, {"Slow", "Next"});
    Node second(GetParam().second, "second", "first", condition);
    const auto slow = std::make_shared<Queue>(100, "Slow");
    const auto next = std::make_shared<Queue>(100, "Next");
    slow->Register_SomethingEnqueued(
        [&]
        {
            condition.Set([&] { began = true; });
            EXPECT_TRUE(condition.Wait([&] { return mayReturn; }));
        });
    next->ConnectSomethingEnqueued(RabitQuickHandler([&] { condition.Set([&] { came = true; }); }));
    first.Workspace.AddManagerMessageQueue("Slow", slow);
    first.Workspace.AddManagerMessageQueue("Next", next);
    while (!second.Workspace.AddMessageToQueue("first/Slow", std::make_shared<Uav::Goto>()))
    {
        std::this_thread::yield();  // not announced yet
    }
    EXPECT_TRUE(condition.Wait([&] { return began; }));
    EXPECT_TRUE(second.Workspace.AddMessageToQueue("first/Next", std::make_shared<Uav::Goto>()));
    EXPECT_TRUE(condition.Wait([&] { return came; }));
    condition.Set([&] { mayReturn = true; });
}

INSTANTIATE_TEST_SUITE_P(Backends, RealNodesTest, ::testing::ValuesIn(AllBackendPairs()), NameOfPair);

}  // namespace
}  // namespace Rabit
