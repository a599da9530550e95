// A node that is a tool beside an ordinary one, with all their threads over each real backend, on loopback.
#include <gtest/gtest.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/FleetExplorer.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <memory>
#include <string>
#include <thread>

#include "../Eventually.h"
#include "BackendPairs.h"
#include "DomainLease.h"
#include "gateway.idl.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

using RabitTest::Eventually;

class Idle : public RabitManager
{
public:
    using RabitManager::RabitManager;
    void ExecuteUnitOfWork() final {}
};

class Process
{
public:
    Process(const GatewayConfig &config, const std::string &backend) : _reactor(Workspace)
    {
        _reactor.SetHandleSignals(false);
        _reactor.AddManager(std::make_unique<Idle>("Commands", Workspace));
        auto gateway = std::make_unique<GatewayManager>(config, MakeTransport(backend), Workspace);
        Explorer = config.Tool ? &gateway->Explorer() : nullptr;
        _reactor.AddManager(std::move(gateway));
        _runner = std::thread([this] { _reactor.Run(); });
    }
    ~Process()
    {
        _reactor.ShutdownAllManagers();
        _runner.join();
    }

    Gateway::Fleet Fleet()
    {
        Gateway::Fleet fleet;
        Workspace.ForceFetchMessage(FleetMessageName, &fleet);
        return fleet;
    }

    RabitWorkspace Workspace;
    FleetExplorer *Explorer = nullptr;  // of a tool

private:
    RabitReactor _reactor;
    std::thread _runner;
};

GatewayConfig Config(const std::string &node)
{
    GatewayConfig config;
    config.Node = node;
    config.Domain = Conformance::OwnDomain();
    config.Interfaces = {"lo"};
    return config;
}

class RealToolTest : public ::testing::TestWithParam<BackendPair>
{
};

TEST_P(RealToolTest, SeesSendsAndLeavesWithoutBeingANodeOfTheFleet)
{
    GatewayConfig nodeConfig = Config("uav1");
    nodeConfig.Accept.push_back({.Queue = "Commands", .Types = {"Uav::Goto"}});
    GatewayConfig toolConfig = Config("tool");
    toolConfig.Tool.emplace();
    Process node(nodeConfig, GetParam().first);
    {
        Process tool(toolConfig, GetParam().second);
        ASSERT_TRUE(Eventually([&] { return tool.Fleet().nodes.size() == 1; }));
        std::shared_ptr<RabitQueueReceipt> receipt;
        const auto send = [&]
        {
            receipt = std::make_shared<RabitQueueReceipt>();  // refused until uav1 has announced itself
            return tool.Workspace.AddMessageToQueue("uav1/Commands", std::make_shared<Uav::Goto>(), receipt);
        };
        ASSERT_TRUE(Eventually(send));
        ASSERT_TRUE(Eventually([&] { return receipt->Outcome() != QueueOutcome::Pending; }));
        EXPECT_EQ(receipt->Outcome(), QueueOutcome::Delivered);
        EXPECT_TRUE(Eventually([&] { return node.Fleet().inbound.size() == 1; }));
        EXPECT_TRUE(node.Fleet().nodes.empty());
    }
    EXPECT_TRUE(Eventually([&] { return node.Fleet().inbound.empty(); })) << "the link of the tool is kept";
    EXPECT_TRUE(node.Fleet().nodes.empty());
}

TEST_P(RealToolTest, LearnsThatItHearsTheWholeFleet)
{
    GatewayConfig toolConfig = Config("tool");
    toolConfig.Tool.emplace();
    Process node1(Config("uav1"), GetParam().first);
    Process node2(Config("uav2"), GetParam().second);
    ASSERT_TRUE(
        Eventually([&] { return node1.Fleet().nodes.size() == 1 && node2.Fleet().nodes.size() == 1; }));
    Process tool(toolConfig, GetParam().second);
    const auto isKnown = [&]
    {
        const auto nodes = tool.Explorer->Nodes();
        return nodes.size() == 2 && nodes[0].HearsTheSame && nodes[1].HearsTheSame;
    };
    EXPECT_TRUE(Eventually(isKnown));
}

INSTANTIATE_TEST_SUITE_P(Backends, RealToolTest, ::testing::ValuesIn(AllBackendPairs()), NameOfPair);

}  // namespace
}  // namespace Rabit
