// Two gateways in one process, on two networks: a ground station between a radio and a LAN.
#include <gmock/gmock.h>

#include <rabit/gateway/ConfigError.h>

#include <memory>
#include <string>
#include <vector>

#include "../core/CapturedLog.h"
#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

GatewayConfig Named(GatewayConfig config, const std::string &name)
{
    config.Name = name;
    return config;
}

// One clock for both networks and all nodes.
class TwoGateways : public ::testing::Test
{
protected:
    struct Process
    {
        explicit Process(const std::shared_ptr<ManualClock> &clock) : Workspace(clock), Reactor(Workspace) {}
        RabitWorkspace Workspace;
        RabitSteppedReactor Reactor;
    };

    TwoGateways()
    {
        Join(ground, Named(GroundConfig(), "Radio"), radio);
        ground.Reactor.AddManager(std::make_unique<IdleManager>("Commands", ground.Workspace));
        ground.Reactor.Start();
        StartLan();
    }

    // In a reactor of its own, so that it may end while the other goes on.
    void StartLan()
    {
        lanReactor = std::make_unique<RabitSteppedReactor>(ground.Workspace);
        lanReactor->AddManager(std::make_unique<GatewayManager>(
            Named(GroundConfig(), "Lan"), std::make_shared<SimulatedTransport>(lan), ground.Workspace));
        lanReactor->Start();
    }

    void Join(Process &process, const GatewayConfig &config, SimulatedNetwork &network)
    {
        process.Reactor.AddManager(std::make_unique<GatewayManager>(
            config, std::make_shared<SimulatedTransport>(network), process.Workspace));
    }

    // An aircraft with a mission control.
    Process &Fly(const std::string &name, SimulatedNetwork &network)
    {
        Process &added = *processes.emplace_back(std::make_unique<Process>(clock));
        Join(added, AircraftConfig(name), network);
        auto mission = std::make_unique<IdleManager>("MissionControl", added.Workspace);
        missions.push_back(mission.get());
        added.Reactor.AddManager(std::move(mission));
        added.Workspace.AddPublishSubscribeMessage("Pose", poses.emplace_back(std::make_shared<Uav::Pose>()));
        added.Reactor.Start();
        return added;
    }

    void RunFor(std::chrono::milliseconds duration)
    {
        for (auto run = 0ms; run < duration; run += 10ms)
        {
            clock->AdvanceTo(clock->Monotonic() + 10ms);
            for (SimulatedNetwork *network : {&radio, &lan})
            {
                network->AdvanceTo(clock->Monotonic() - Start);
            }
            ground.Reactor.RunDue();
            if (lanReactor)
            {
                lanReactor->RunDue();
            }
            for (std::size_t i = 0; i < processes.size(); ++i)
            {
                poses[i]->PostMessage();
                processes[i]->Reactor.RunDue();
            }
        }
    }

    bool Send(const std::string &address)
    {
        receipt = std::make_shared<RabitQueueReceipt>();
        return ground.Workspace.AddMessageToQueue(address, std::make_shared<Uav::Goto>(), receipt);
    }

    // Returns the number of messages that the mission control of the n-th aircraft has got since the last
    // call.
    int Got(std::size_t aircraft)
    {
        int count = 0;
        std::shared_ptr<RabitMessage> message;
        while (missions[aircraft]->GetManagerMessageQueue()->GetMessage(message))
        {
            ++count;
        }
        return count;
    }

    std::string Problems(const std::string &gateway)
    {
        Gateway::Fleet fleet;
        ground.Workspace.ForceFetchMessage(gateway + "/Fleet", &fleet);
        std::string text;
        for (const Gateway::Problem &problem : fleet.problems)
        {
            text += problem.subject + ": " + problem.reason + "\n";
        }
        return text;
    }

    static constexpr std::chrono::nanoseconds Start = 1000s;
    const std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>(1.4e9, Start);
    RabitTest::CapturedLog log;
    SimulatedNetwork radio{1};
    SimulatedNetwork lan{2};
    Process ground{clock};
    std::unique_ptr<RabitSteppedReactor> lanReactor;
    std::vector<std::unique_ptr<Process>> processes;
    std::vector<IdleManager *> missions;
    std::vector<std::shared_ptr<Uav::Pose>> poses;
    std::shared_ptr<RabitQueueReceipt> receipt;
};

TEST_F(TwoGateways, EachHandlesTheNodesThatItKnows)
{
    Fly("uav1", radio);
    Fly("uav2", lan);
    RunFor(3s);
    EXPECT_TRUE(Send("uav1/MissionControl"));
    EXPECT_TRUE(Send("uav2/MissionControl"));
    RunFor(1s);
    EXPECT_EQ(Got(0), 1);
    EXPECT_EQ(Got(1), 1);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Delivered);
    for (const char *name : {"uav1/Pose", "uav2/Pose"})
    {
        Uav::Pose pose;
        EXPECT_TRUE(ground.Workspace.ForceFetchMessage(name, &pose)) << name;
    }
    EXPECT_THAT(Problems("Radio") + Problems("Lan"), Not(HasSubstr("node ")));
}

TEST_F(TwoGateways, WhatNeitherKnowsIsRefusedOnceAndForgivenWhereverItIsTaken)
{
    RunFor(1s);
    EXPECT_FALSE(Send("uav2/MissionControl"));
    EXPECT_EQ(receipt->GetCounts().Refused, 1u);
    EXPECT_FALSE(Send("*/MissionControl"));
    RunFor(1500ms);
    EXPECT_THAT(Problems("Radio"), HasSubstr("send uav2/MissionControl: "));
    EXPECT_THAT(Problems("Lan"), Not(HasSubstr("send ")));
    Fly("uav2", lan);
    RunFor(3s);
    EXPECT_TRUE(Send("uav2/MissionControl"));
    EXPECT_TRUE(Send("*/MissionControl"));
    RunFor(2s);
    EXPECT_THAT(Problems("Radio"), Not(HasSubstr("send ")));
}

TEST_F(TwoGateways, AStarReachesTheNodesOfBothEachOnce)
{
    Fly("uav1", radio);
    Fly("uav2", lan);
    Fly("both", radio);
    Fly("both", lan);
    RunFor(3s);
    EXPECT_TRUE(Send("*/MissionControl"));
    RunFor(1s);
    EXPECT_EQ(Got(0), 1);
    EXPECT_EQ(Got(1), 1);
    EXPECT_EQ(Got(2) + Got(3), 1);
    EXPECT_EQ(receipt->GetCounts().Delivered, 3u);
}

TEST_F(TwoGateways, ANodeThatBothKnowIsAProblemByName)
{
    Fly("both", radio);
    Fly("both", lan);
    RunFor(8s);
    const std::string through = "queue messages for it go through `Radio`";
    EXPECT_THAT(Problems("Radio"),
                HasSubstr("node both: the gateway `Lan` knows a node of this name too; " + through));
    EXPECT_THAT(Problems("Lan"),
                HasSubstr("node both: the gateway `Radio` knows a node of this name too; " + through));
    EXPECT_THAT(log.Lines(), ::testing::Contains(HasSubstr("gateway Radio: node both: ")));
    EXPECT_TRUE(Send("both/MissionControl"));
    RunFor(1s);
    EXPECT_EQ(Got(0), 1);
    EXPECT_EQ(Got(1), 0);
}

TEST_F(TwoGateways, ASecondOfOneNameIsAnErrorAndDisturbsNothing)
{
    Fly("uav1", radio);
    RunFor(3s);
    try
    {
        Join(ground, Named(GroundConfig(), "Radio"), lan);
        FAIL() << "no error";
    }
    catch (const ConfigError &error)
    {
        EXPECT_STREQ(error.what(),
                     "there is a gateway `Radio` in this workspace already; each needs a `name` "
                     "of its own");
    }
    EXPECT_TRUE(Send("uav1/MissionControl"));
    RunFor(1s);
    EXPECT_EQ(Got(0), 1);
}

TEST_F(TwoGateways, WhenOneEndsTheOtherGoesOn)
{
    Fly("uav1", radio);
    Fly("uav2", lan);
    RunFor(3s);
    lanReactor.reset();
    EXPECT_TRUE(Send("uav1/MissionControl"));
    EXPECT_FALSE(Send("uav2/MissionControl"));
    EXPECT_TRUE(Send("*/MissionControl"));
    RunFor(1s);
    EXPECT_EQ(Got(0), 2);
    EXPECT_EQ(Got(1), 0);
}

TEST_F(TwoGateways, OneThatEndedMayComeAgain)
{
    Fly("uav2", lan);
    RunFor(3s);
    lanReactor.reset();
    RunFor(3s);
    StartLan();
    RunFor(3s);
    EXPECT_TRUE(Send("uav2/MissionControl"));
    RunFor(1s);
    EXPECT_EQ(Got(0), 1);
}

}  // namespace
}  // namespace Rabit
