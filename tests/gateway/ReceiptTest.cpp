// The receipts of single queue messages, as a sender sees them: whole nodes on the simulated network.
#include <rabit/RabitQueueReceipt.h>

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class ReceiptTest : public ::testing::Test
{
protected:
    ReceiptTest()
        : uav(&fleet.Add(AircraftConfig("uav1"))),
          mission(&uav->AddIdleManager("MissionControl")),
          ground(fleet.Add(GroundWithRules()))
    {
        fleet.RunFor(2s);
    }

    static GatewayConfig GroundWithRules()
    {
        GatewayConfig config = GroundConfig();
        config.Send.push_back({.To = "uav1", .Capacity = 10});
        config.Send.push_back({.To = "uav2", .Expire = 5s});
        config.Send.push_back({.To = "uav3", .RedeliverInDoubt = true});
        return config;
    }

    std::shared_ptr<RabitQueueReceipt> Send(const std::string &address)
    {
        auto receipt = std::make_shared<RabitQueueReceipt>();
        ground.Workspace.AddMessageToQueue(address, std::make_shared<Uav::Goto>(), receipt);
        return receipt;
    }
    std::shared_ptr<RabitQueueReceipt> Send() { return Send("uav1/MissionControl"); }

    void Cut()
    {
        SimulatedFaults cut;
        cut.Cut = true;
        fleet.Network.SetFaults("*", "*", cut);
    }

    SimulatedFleet fleet;
    SimulatedNode *uav;
    IdleManager *mission;
    SimulatedNode &ground;
};

TEST_F(ReceiptTest, IsPendingUntilTheOtherSideAcknowledged)
{
    const auto receipt = Send();
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Pending);
    fleet.RunFor(1s);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Delivered);
}

TEST_F(ReceiptTest, WakesTheManagerThatWaitsForIt)
{
    IdleManager &commander = ground.AddIdleManager("Commander");
    commander.SetWakeupTimeDelaySec(3600);
    fleet.RunFor(1s);
    const int before = commander.Passes;
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    commander.WakeUpManagerOnOutcome(receipt);
    EXPECT_TRUE(commander.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>(), receipt));
    fleet.RunFor(1s);
    EXPECT_EQ(commander.Passes, before + 1);
}

TEST_F(ReceiptTest, SaysExpiredWhenTheTimeRanOutOnTheWay)
{
    fleet.Add(AircraftConfig("uav2"));
    fleet.RunFor(2s);
    Cut();
    const auto receipt = Send("uav2/MissionControl");
    fleet.RunFor(20s);
    fleet.Network.ClearFaults();
    fleet.RunFor(10s);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Expired);
}

TEST_F(ReceiptTest, SaysInDoubtWhenTheReceiverRestartedBeforeItAcknowledged)
{
    Send();
    fleet.RunFor(1s);
    fleet.Network.SetFaults("uav1", "ground", {.Cut = true});  // the message arrives, the answer does not
    const auto receipt = Send();
    fleet.RunFor(500ms);
    fleet.Kill("uav1");
    fleet.Network.ClearFaults();
    fleet.Add(AircraftConfig("uav1"), 1.4e9 + 60);
    fleet.RunFor(10s);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::InDoubt);
}

TEST_F(ReceiptTest, TellsWhyAMessageWasRefusedAtTheCall)
{
    ground.AddIdleManager("Commands");
    EXPECT_EQ(Send()->RefusalReason(), "");
    EXPECT_THAT(Send("uav9/MissionControl")->RefusalReason(),
                HasSubstr("no node `uav9` has announced itself"));
    EXPECT_THAT(Send("uav1/Mission")->RefusalReason(), HasSubstr("`Mission`"));
    EXPECT_EQ(Send("*/Nothing")->RefusalReason(), "no live node accepts `Uav::Goto` for `Nothing`");
    EXPECT_EQ(Send("ground/Comands")->RefusalReason(), "there is no queue `Comands`");
    for (int i = 0; i < RabitManager::DefaultQueueCapacity; ++i)
    {
        EXPECT_EQ(Send("ground/Commands")->RefusalReason(), "");
    }
    EXPECT_EQ(Send("ground/Commands")->RefusalReason(), "the queue `Commands` is full");
}

TEST_F(ReceiptTest, SaysRefusedWhenTheOutboxIsFull)
{
    Cut();
    for (int i = 0; i < 10; ++i)
    {
        EXPECT_EQ(Send()->Outcome(), QueueOutcome::Pending);
    }
    EXPECT_EQ(Send()->Outcome(), QueueOutcome::Refused);
    EXPECT_EQ(Send()->RefusalReason(), "outbox full by count");
}

TEST_F(ReceiptTest, SaysRefusedForAnUnknownNode)
{
    EXPECT_EQ(Send("uav7/MissionControl")->Outcome(), QueueOutcome::Refused);
    EXPECT_EQ(Send("*/NoSuchQueue")->Outcome(), QueueOutcome::Refused);
}

TEST_F(ReceiptTest, ARefusalAtTheCallTellsNoHandler)
{
    Cut();
    for (int i = 0; i < 10; ++i)
    {
        Send();  // fills the outbox
    }
    for (const char *address : {"uav1/MissionControl", "uav1/NoSuchQueue", "uav7/MissionControl",
                                "*/NoSuchQueue", "ground/NoSuchQueue", "NoSuchQueue"})
    {
        const auto receipt = std::make_shared<RabitQueueReceipt>();
        int known = 0;
        receipt->ConnectOutcomeKnown([&known] { ++known; });
        EXPECT_FALSE(ground.Workspace.AddMessageToQueue(address, std::make_shared<Uav::Goto>(), receipt))
            << address;
        EXPECT_EQ(receipt->Outcome(), QueueOutcome::Refused) << address;
        EXPECT_EQ(known, 0) << address;
    }
}

TEST_F(ReceiptTest, OfAMessageToAllThatOneOfThemRefusesTellsItsHandlersOnceTheOthersAreSettled)
{
    fleet.Add(AircraftConfig("uav2")).AddIdleManager("MissionControl");
    fleet.RunFor(2s);
    Cut();
    for (int i = 0; i < 10; ++i)
    {
        Send();  // fills the outbox of uav1
    }
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    int known = 0;
    receipt->ConnectOutcomeKnown([&known] { ++known; });
    EXPECT_FALSE(
        ground.Workspace.AddMessageToQueue("*/MissionControl", std::make_shared<Uav::Goto>(), receipt));
    EXPECT_EQ(receipt->GetCounts().Refused, 1u);
    EXPECT_EQ(receipt->GetCounts().Pending, 1u);
    EXPECT_EQ(known, 0);
    fleet.Network.SetFaults("*", "*", {});
    fleet.RunFor(3s);
    EXPECT_EQ(receipt->GetCounts().Delivered, 1u);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Refused);
    EXPECT_EQ(known, 1);
}

TEST_F(ReceiptTest, OfAMessageToAllCountsEachNode)
{
    fleet.Add(AircraftConfig("uav2")).AddIdleManager("MissionControl");
    fleet.RunFor(2s);
    const auto receipt = Send("*/MissionControl");
    EXPECT_EQ(receipt->GetCounts().Pending, 2u);
    fleet.RunFor(1s);
    EXPECT_EQ(receipt->GetCounts().Delivered, 2u);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Delivered);
}

TEST_F(ReceiptTest, OfANodesOwnQueueByItsFullNameIsSettledAtOnce)
{
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    EXPECT_TRUE(
        uav->Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>(), receipt));
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Delivered);
}

TEST_F(ReceiptTest, ComesToAnEndWithTheGateway)
{
    Cut();
    fleet.RunFor(5s);  // nothing is sent to a silent peer
    const auto receipt = Send();
    fleet.Stop("ground");
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Expired);
}

TEST_F(ReceiptTest, AMessageInDoubtThatIsSentAgainSaysSoToItsReceiver)
{
    fleet.Add(AircraftConfig("uav3")).AddIdleManager("MissionControl");
    fleet.RunFor(2s);
    Send("uav3/MissionControl");
    fleet.RunFor(1s);
    fleet.Network.SetFaults("uav3", "ground", {.Cut = true});
    const auto receipt = Send("uav3/MissionControl");
    fleet.RunFor(500ms);
    fleet.Kill("uav3");
    fleet.Network.ClearFaults();
    IdleManager &manager = fleet.Add(AircraftConfig("uav3"), 1.4e9 + 60).AddIdleManager("MissionControl");
    fleet.RunFor(10s);
    std::shared_ptr<RabitMessage> message;
    ASSERT_TRUE(manager.GetManagerMessageQueue()->GetMessage(message));
    EXPECT_TRUE(message->IsRedelivered());
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Delivered);
}

TEST_F(ReceiptTest, AMessageThatCameOnceIsNotMarkedAsRedelivered)
{
    Send();
    fleet.RunFor(1s);
    std::shared_ptr<RabitMessage> message;
    ASSERT_TRUE(mission->GetManagerMessageQueue()->GetMessage(message));
    EXPECT_FALSE(message->IsRedelivered());
}

TEST(GatewayLives, AStateDirectoryThatCannotBeUsedIsReportedAndTheNodeRuns)
{
    const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "rabit_state_is_a_file";
    std::ofstream(file) << "not a directory";
    SimulatedFleet fleet;
    GatewayConfig config = AircraftConfig("uav1");
    config.StateDir = (file / "state").string();
    SimulatedNode &uav = fleet.Add(config);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    fleet.RunFor(3s);
    EXPECT_THAT(uav.Problems(), HasSubstr("state_dir " + config.StateDir + ": cannot"));
    EXPECT_EQ(ground.StateOf("uav1"), "UP");
    std::filesystem::remove(file);
}

TEST(GatewayLives, TheCounterInTheStateDirectoryRisesWithEachLife)
{
    const std::filesystem::path directory = std::filesystem::path(::testing::TempDir()) / "rabit_state";
    std::filesystem::remove_all(directory);
    SimulatedFleet fleet;
    GatewayConfig config = AircraftConfig("uav1");
    config.StateDir = directory.string();
    SimulatedNode &first = fleet.Add(config);
    fleet.RunFor(2s);
    const std::uint64_t before = first.Fleet().incarnation;
    fleet.Kill("uav1");
    SimulatedNode &second = fleet.Add(config);
    fleet.RunFor(2s);
    EXPECT_GT(second.Fleet().incarnation >> 32, before >> 32);
    std::filesystem::remove_all(directory);
}

TEST(GatewayLives, ALifeThatIsTakenBecauseOthersKnowAHigherOneIsStored)
{
    const std::filesystem::path directory = std::filesystem::path(::testing::TempDir()) / "rabit_state_lost";
    std::filesystem::remove_all(directory);
    SimulatedFleet fleet;
    GatewayConfig config = AircraftConfig("uav1");
    config.StateDir = directory.string();
    SimulatedNode &ground = fleet.Add(GroundConfig());
    SimulatedNode &uav = fleet.Add(config);
    fleet.RunFor(2s);
    const std::uint64_t before = uav.Fleet().incarnation >> 32;
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
    fleet.RunFor(2s);
    fleet.Kill("uav1");
    std::filesystem::remove_all(directory);
    fleet.RunFor(5s);
    // The node comes back without its file, and with a clock that is a year behind.
    fleet.Add(config, 1.4e9 - 365.0 * 86400);
    fleet.RunFor(20s);
    std::uint64_t stored = 0;
    std::ifstream(directory / "uav1.incarnation") >> stored;
    EXPECT_GT(stored, before);
    std::filesystem::remove_all(directory);
}

TEST(GatewayLives, AGatewayThatIsRunAgainJoinsInANewLife)
{
    SimulatedFleet fleet;
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    fleet.RunFor(2s);
    const std::uint64_t before = uav.Fleet().incarnation;
    uav.Reactor.Stop();
    fleet.RunFor(5s);
    EXPECT_EQ(ground.StateOf("uav1"), "LOST");
    uav.Reactor.Start();
    EXPECT_TRUE(fleet.RunUntil([&] { return ground.StateOf("uav1") == "UP"; }, 10s));
    EXPECT_NE(uav.Fleet().incarnation, before);
    IdleManager &mission = uav.AddIdleManager("MissionControl");
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
    fleet.RunFor(5s);
    EXPECT_EQ(mission.GetManagerMessageQueue()->NoMessagesInQueue(), 1);
}

}  // namespace
}  // namespace Rabit
