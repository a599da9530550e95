// Queue messages between nodes: whole nodes on the simulated network. The link protocol has tests of its own.
#include <gmock/gmock.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/dynamic/DynamicType.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "HandNode.h"
#include "SimulatedFleet.h"
#include "names/TypeDefinition.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class QueueTest : public ::testing::Test
{
protected:
    QueueTest()
        : uav(fleet.Add(AircraftConfig("uav1"))),
          mission(uav.AddIdleManager("MissionControl")),
          ground(fleet.Add(GroundConfig()))
    {
        fleet.RunFor(2s);
    }

    bool SendGoto(std::uint32_t id, const std::string &address = "uav1/MissionControl")
    {
        auto message = std::make_shared<Uav::Goto>();
        message->id = id;
        return ground.Workspace.AddMessageToQueue(address, message);
    }

    // Takes all messages from a manager's queue. Returns the ids of Gotos, and the target numbers of
    // reports as negatives.
    static std::vector<int> Take(RabitManager &manager)
    {
        std::vector<int> ids;
        std::shared_ptr<RabitMessage> message;
        while (manager.GetManagerMessageQueue()->GetMessage(message))
        {
            if (const auto command = std::dynamic_pointer_cast<Uav::Goto>(message))
            {
                ids.push_back(static_cast<int>(command->id));
            }
            else if (const auto report = std::dynamic_pointer_cast<Uav::TargetReport>(message))
            {
                ids.push_back(-static_cast<int>(report->target));
            }
        }
        return ids;
    }

    SimulatedFleet fleet;
    SimulatedNode &uav;
    IdleManager &mission;
    SimulatedNode &ground;
};

TEST_F(QueueTest, AMessageArrivesInTheRealQueueAndWakesItsManager)
{
    mission.SetWakeupTimeDelaySec(3600);
    fleet.RunFor(1s);
    const int before = mission.Passes;
    EXPECT_TRUE(SendGoto(7));
    fleet.RunFor(1s);
    EXPECT_THAT(Take(mission), ElementsAre(7));
    EXPECT_EQ(mission.Passes, before + 1);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").delivered, 1u);
}

TEST_F(QueueTest, MessagesOfAllTypesArriveInOrder)
{
    for (std::uint32_t i = 1; i <= 4; ++i)
    {
        SendGoto(i);
        auto report = std::make_shared<Uav::TargetReport>();
        report->target = i;
        EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", report));
    }
    fleet.RunFor(1s);
    EXPECT_THAT(Take(mission), ElementsAre(1, -1, 2, -2, 3, -3, 4, -4));
}

TEST_F(QueueTest, OnAPathThatLosesNothingNothingIsSentTwice)
{
    // Messages go one way only, so that nothing else makes the receiving gateway run when an
    // acknowledgement is due.
    for (std::uint32_t i = 1; i <= 2000; ++i)
    {
        EXPECT_TRUE(SendGoto(i));
        fleet.RunFor(1ms);
        Take(mission);
    }
    fleet.RunFor(2s);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").delivered, 2000u);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").resent, 0u);
}

TEST_F(QueueTest, AQueueThatIsExactlyFullIsFilledAgainAsSoonAsThereIsRoom)
{
    constexpr int Messages = 100;
    GatewayConfig config = AircraftConfig("uav2");
    config.Accept.push_back({.Queue = "Small", .Types = {"Uav::Goto"}});
    SimulatedNode &other = fleet.Add(config);
    const auto small = std::make_shared<RabitMessageQueue<std::shared_ptr<RabitMessage>>>(4, "Small");
    other.Workspace.AddManagerMessageQueue("Small", small);
    fleet.RunFor(2s);
    for (std::uint32_t i = 1; i <= Messages; ++i)
    {
        EXPECT_TRUE(SendGoto(i, "uav2/Small"));
    }
    // The manager takes all waiting messages every 5 ms: four at a time if they come as soon as there is
    // room. The resend timer alone would bring them every 20 ms at best.
    int taken = 0;
    for (int turn = 0; turn < 40; ++turn)
    {
        fleet.RunFor(5ms);
        std::shared_ptr<RabitMessage> message;
        while (small->GetMessage(message))
        {
            ++taken;
        }
    }
    EXPECT_EQ(taken, Messages);
}

TEST_F(QueueTest, LossDoesNotLoseMessages)
{
    SimulatedFaults lossy;
    lossy.Loss = 0.3;
    lossy.Duplicate = 0.2;
    lossy.Jitter = 30ms;
    fleet.Network.SetFaults("*", "*", lossy);
    std::vector<int> expected;
    std::vector<int> taken;
    for (int i = 1; i <= 500; ++i)
    {
        EXPECT_TRUE(SendGoto(static_cast<std::uint32_t>(i)));
        expected.push_back(i);
        fleet.RunFor(10ms);
        const std::vector<int> some = Take(mission);
        taken.insert(taken.end(), some.begin(), some.end());
    }
    fleet.RunFor(20s);
    const std::vector<int> rest = Take(mission);
    taken.insert(taken.end(), rest.begin(), rest.end());
    EXPECT_EQ(taken, expected);
}

TEST_F(QueueTest, AnOutageLongerThanEveryLeaseLosesNothing)
{
    SimulatedFaults cut;
    cut.Cut = true;
    fleet.Network.SetFaults("*", "*", cut);
    fleet.RunFor(1s);
    EXPECT_TRUE(SendGoto(1));
    fleet.RunFor(20s);
    EXPECT_EQ(ground.StateOf("uav1"), "LOST");
    EXPECT_TRUE(SendGoto(2));
    fleet.RunFor(20s);
    fleet.Network.ClearFaults();
    fleet.RunFor(10s);
    EXPECT_THAT(Take(mission), ElementsAre(1, 2));
}

TEST_F(QueueTest, AFullRemoteQueueHoldsTheStreamBackWithoutLoss)
{
    // The manager's queue holds 1000; the outbox another 1000.
    for (std::uint32_t i = 1; i <= 1500; ++i)
    {
        EXPECT_TRUE(SendGoto(i));
        fleet.RunFor(1ms);
    }
    fleet.RunFor(5s);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").delivered, 1000u);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").outbox, 500u);
    EXPECT_TRUE(uav.Fleet().inbound.at(0).held_back);
    EXPECT_EQ(Take(mission).size(), 1000u);
    fleet.RunFor(5s);
    EXPECT_EQ(Take(mission).size(), 500u);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").outbox, 0u);
}

TEST_F(QueueTest, AQueueThatNobodyReadsIsAProblemOfBothSidesUntilItIsRead)
{
    for (std::uint32_t i = 1; i <= 2500; ++i)
    {
        SendGoto(i);
        fleet.RunFor(1ms);
    }
    fleet.RunFor(8s);
    EXPECT_THAT(
        uav.Problems(),
        HasSubstr("queue MissionControl: it is full (1000 messages), and its manager takes no messages from "
                  "it, or too few: those of `ground` wait"));
    EXPECT_THAT(ground.Problems(),
                HasSubstr("send uav1/MissionControl: no more messages may wait, and they are refused: that "
                          "queue is full"));
    while (!Take(mission).empty())
    {
        fleet.RunFor(1s);
    }
    fleet.RunFor(1s);
    EXPECT_THAT(uav.Problems(), Not(HasSubstr("queue MissionControl")));
    EXPECT_THAT(ground.Problems(), Not(HasSubstr("send uav1")));
}

TEST_F(QueueTest, AQueueThatNobodyReadsIsNoProblemOfAnotherQueueOfThatNode)
{
    GatewayConfig config = AircraftConfig("uav2");
    config.Accept.push_back({.Queue = "Camera", .Types = {"Uav::Goto"}});
    SimulatedNode &second = fleet.Add(config);
    second.AddIdleManager("MissionControl");
    IdleManager &camera = second.AddIdleManager("Camera");
    fleet.RunFor(2s);
    for (std::uint32_t i = 1; i <= 1100; ++i)
    {
        EXPECT_TRUE(SendGoto(i, "uav2/MissionControl"));
        fleet.RunFor(1ms);
    }
    for (std::uint32_t i = 1; i <= 80; ++i)
    {
        EXPECT_TRUE(SendGoto(i, "uav2/Camera"));
        fleet.RunFor(100ms);
        Take(camera);
    }
    EXPECT_TRUE(ground.LinkTo("uav2", "MissionControl").held_back);
    EXPECT_FALSE(ground.LinkTo("uav2", "Camera").held_back);
    EXPECT_THAT(second.Problems(), HasSubstr("queue MissionControl: it is full"));
    EXPECT_THAT(second.Problems(), Not(HasSubstr("queue Camera")));
    EXPECT_THAT(ground.Problems(), HasSubstr("send uav2/MissionControl: messages wait: that queue is full"));
    EXPECT_THAT(ground.Problems(), Not(HasSubstr("uav2/Camera")));
}

TEST_F(QueueTest, AFullQueueHoldsBackOnlyTheNodesWhoseMessagesWait)
{
    GatewayConfig config = GroundConfig();
    config.Node = "ground2";
    SimulatedNode &second = fleet.Add(config);
    fleet.RunFor(2s);
    EXPECT_TRUE(second.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
    fleet.RunFor(1s);
    for (std::uint32_t i = 1; i <= 1100; ++i)
    {
        EXPECT_TRUE(SendGoto(i));
        fleet.RunFor(1ms);
    }
    fleet.RunFor(5s);
    const Gateway::Fleet seen = uav.Fleet();
    ASSERT_EQ(seen.inbound.size(), 2u);
    for (const Gateway::InboundStatus &stream : seen.inbound)
    {
        EXPECT_EQ(stream.held_back, stream.node == "ground") << stream.node;
    }
}

TEST_F(QueueTest, AFullOutboxRefusesAtOnceAndCounts)
{
    SimulatedFaults cut;
    cut.Cut = true;
    fleet.Network.SetFaults("*", "*", cut);
    for (std::uint32_t i = 1; i <= 1000; ++i)
    {
        EXPECT_TRUE(SendGoto(i));
    }
    EXPECT_FALSE(SendGoto(1001));
    fleet.RunFor(1500ms);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").refused_full, 1u);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").accepted, 1000u);
}

TEST_F(QueueTest, AMessageThatIsLargerThanTheOutboxDoesNotCountAsOneThatFoundItFull)
{
    GatewayConfig config = GroundConfig();
    config.Node = "station";
    config.Send = {SendRule{}};
    config.Send[0].CapacityBytes = 8;
    SimulatedNode &station = fleet.Add(config);
    fleet.RunFor(2s);
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    EXPECT_FALSE(
        station.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>(), receipt));
    EXPECT_EQ(receipt->RefusalReason(), "the message is larger than the outbox");
    fleet.RunFor(1500ms);
    EXPECT_EQ(station.LinkTo("uav1", "MissionControl").refused_full, 0u);
    EXPECT_EQ(station.LinkTo("uav1", "MissionControl").refused_type, 1u);
    EXPECT_THAT(station.Problems(),
                HasSubstr("send uav1/MissionControl: the message is larger than the outbox"));
}

TEST_F(QueueTest, AnUnknownNodeIsRefusedAndNamed)
{
    EXPECT_FALSE(SendGoto(1, "uav7/MissionControl"));
    fleet.RunFor(1500ms);
    EXPECT_EQ(ground.LinkTo("uav7", "MissionControl").refused_unknown, 1u);
    EXPECT_THAT(ground.Problems(),
                HasSubstr("send uav7/MissionControl: no node `uav7` has announced itself"));
}

TEST_F(QueueTest, AQueueThatIsNotAcceptedIsRefusedAndNamed)
{
    EXPECT_FALSE(SendGoto(1, "uav1/Missions"));
    fleet.RunFor(1500ms);
    EXPECT_EQ(ground.LinkTo("uav1", "Missions").refused_unknown, 1u);
    EXPECT_THAT(
        ground.Problems(),
        HasSubstr("send uav1/Missions: uav1 accepts no queue `Missions`; it accepts `MissionControl`"));
}

TEST_F(QueueTest, ATypeThatTheQueueDoesNotTakeIsRefusedAndNamed)
{
    EXPECT_FALSE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Pose>()));
    fleet.RunFor(1500ms);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").refused_type, 1u);
    EXPECT_THAT(ground.Problems(),
                HasSubstr("does not accept `Uav::Pose`; it accepts `Uav::Goto`, `Uav::TargetReport`"));
}

TEST_F(QueueTest, AMessageThatDoesNotFitItsIdlBoundsIsRefused)
{
    auto message = std::make_shared<Uav::Goto>();
    message->reply_to = std::string(65, 'x');
    EXPECT_FALSE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", message));
}

TEST_F(QueueTest, AMessageChangedAfterItWasAcceptedArrivesAsItWas)
{
    auto message = std::make_shared<Uav::Goto>();
    message->id = 1;
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", message));
    message->id = 2;
    fleet.RunFor(1s);
    EXPECT_THAT(Take(mission), ElementsAre(1));
}

TEST_F(QueueTest, AStarSendsToEveryLiveNodeThatAccepts)
{
    SimulatedNode &second = fleet.Add(AircraftConfig("uav2"));
    IdleManager &secondMission = second.AddIdleManager("MissionControl");
    fleet.Add(AircraftConfig("uav3"));
    fleet.RunFor(2s);
    fleet.Stop("uav3");
    fleet.RunFor(2s);
    EXPECT_TRUE(SendGoto(5, "*/MissionControl"));
    EXPECT_FALSE(SendGoto(5, "*/NoSuchQueue"));
    fleet.RunFor(1s);
    EXPECT_THAT(Take(mission), ElementsAre(5));
    EXPECT_THAT(Take(secondMission), ElementsAre(5));
    EXPECT_EQ(ground.LinkTo("uav3", "MissionControl").accepted, 0u);
}

TEST_F(QueueTest, AStarThatNobodyHasAQueueForIsNoProblemButOneOfAnotherTypeIs)
{
    EXPECT_FALSE(SendGoto(5, "*/NoSuchQueue"));
    fleet.RunFor(3s);
    EXPECT_EQ(ground.LinkTo("*", "NoSuchQueue").refused_unknown, 1u);
    EXPECT_THAT(ground.Problems(), Not(HasSubstr("NoSuchQueue")));
    EXPECT_FALSE(ground.Workspace.AddMessageToQueue("*/MissionControl", std::make_shared<Uav::Pose>()));
    fleet.RunFor(3s);
    EXPECT_THAT(
        ground.Problems(),
        HasSubstr("send */MissionControl: no live node accepts `Uav::Pose` for `MissionControl`: queue "
                  "`MissionControl` of uav1 does not accept `Uav::Pose`"));
}

// Its announcement is under way, so nobody knows whether it has the queue.
TEST_F(QueueTest, AStarTellsOfALiveNodeWhoseAnnouncementHasNotArrived)
{
    HandNode second(fleet.Network, "uav2", 7);
    fleet.RunFor(1s);
    Gateway::Beat beat = second.Beat();
    beat.offers = 99;
    second.Write(beat);
    fleet.RunFor(200ms);
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    EXPECT_FALSE(
        ground.Workspace.AddMessageToQueue("*/MissionControl", std::make_shared<Uav::Goto>(), receipt));
    fleet.RunFor(1500ms);
    EXPECT_EQ(receipt->GetCounts().Delivered, 1u);
    EXPECT_EQ(receipt->GetCounts().Refused, 1u);
    EXPECT_EQ(Take(mission).size(), 1u);
    EXPECT_THAT(ground.Problems(),
                HasSubstr("send uav2/MissionControl: no announcement of uav2 has arrived yet"));
}

TEST_F(QueueTest, ARefusalIsNoProblemAnyMoreAfterAMinute)
{
    EXPECT_FALSE(SendGoto(1, "uav1/Missions"));
    fleet.RunFor(50s);
    EXPECT_THAT(ground.Problems(), HasSubstr("send uav1/Missions"));
    fleet.RunFor(12s);
    EXPECT_THAT(ground.Problems(), Not(HasSubstr("send uav1/Missions")));
    EXPECT_EQ(ground.LinkTo("uav1", "Missions").refused_unknown, 1u) << "it stays counted";
}

TEST_F(QueueTest, AnotherNodeOfThisNameIsNoProblemAnyMoreOnceItIsGone)
{
    const char *const problem = "another live node must have the name of this one";
    SimulatedNode &twin = fleet.Add(GroundConfig(), 1.5e9, "twin");
    bool wasTold = false;
    for (std::uint32_t i = 1; i <= 30; ++i)
    {
        SendGoto(i);
        auto message = std::make_shared<Uav::Goto>();
        message->id = 100 + i;
        twin.Workspace.AddMessageToQueue("uav1/MissionControl", message);
        fleet.RunFor(2s);
        Take(mission);
        wasTold = wasTold || ground.Problems().find(problem) != std::string::npos;
    }
    ASSERT_TRUE(wasTold);
    fleet.Stop("twin");
    fleet.RunFor(30s);
    EXPECT_THAT(ground.Problems(), Not(HasSubstr(problem)));
}

TEST_F(QueueTest, ANodeCanAddressItsOwnQueueByItsFullName)
{
    EXPECT_TRUE(uav.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
    EXPECT_EQ(Take(mission).size(), 1u);
}

TEST_F(QueueTest, MessagesWaitForAManagerThatComesLater)
{
    SimulatedNode &late = fleet.Add(AircraftConfig("uav2"));
    fleet.RunFor(2s);
    EXPECT_TRUE(SendGoto(9, "uav2/MissionControl"));
    fleet.RunFor(5s);
    EXPECT_THAT(late.Problems(),
                HasSubstr("accept MissionControl: there is no local queue `MissionControl`"));
    IdleManager &manager = late.AddIdleManager("MissionControl");
    fleet.RunFor(5s);
    EXPECT_THAT(Take(manager), ElementsAre(9));
}

TEST_F(QueueTest, ASecondLiveNodeOfOneNameDoesNotHarmTheLinksOfOthers)
{
    SimulatedNode &other = fleet.Add(AircraftConfig("uav2"));
    IdleManager &otherMission = other.AddIdleManager("MissionControl");
    SimulatedNode &twin = fleet.Add(AircraftConfig("uav1"), 1.4e9, "twin of uav1");
    twin.AddIdleManager("MissionControl");
    fleet.RunFor(2s);
    std::vector<int> expected;
    for (int i = 1; i <= 200; ++i)
    {
        EXPECT_TRUE(SendGoto(static_cast<std::uint32_t>(i), "uav2/MissionControl"));
        SendGoto(static_cast<std::uint32_t>(i), "uav1/MissionControl");
        expected.push_back(i);
        fleet.RunFor(50ms);
    }
    fleet.RunFor(5s);
    EXPECT_EQ(Take(otherMission), expected);
    EXPECT_EQ(ground.LinkTo("uav2", "MissionControl").delivered, 200u);
}

TEST_F(QueueTest, WithASecondLiveNodeOfItsNameNoneOfTheTwoGetsAMessageTwiceOrOutOfOrder)
{
    SimulatedNode &twin = fleet.Add(AircraftConfig("uav1"), 1.4e9, "twin of uav1");
    IdleManager &twinMission = twin.AddIdleManager("MissionControl");
    fleet.RunFor(2s);
    for (int i = 1; i <= 200; ++i)
    {
        SendGoto(static_cast<std::uint32_t>(i));
        fleet.RunFor(50ms);
    }
    fleet.RunFor(5s);
    std::vector<int> all = Take(mission);
    const std::vector<int> twins = Take(twinMission);
    EXPECT_FALSE(all.empty() && twins.empty());
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    EXPECT_TRUE(std::is_sorted(twins.begin(), twins.end()));
    all.insert(all.end(), twins.begin(), twins.end());
    std::sort(all.begin(), all.end());
    EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
    // The reported outcomes are true as well.
    EXPECT_LE(ground.LinkTo("uav1", "MissionControl").delivered, all.size());
}

TEST_F(QueueTest, TwoLiveNodesOfOneNameThatSendToOneQueueAreBothDelivered)
{
    SimulatedNode &twin = fleet.Add(GroundConfig(), 1.4e9, "twin of ground");
    fleet.RunFor(2s);
    std::size_t accepted = 0;
    for (int i = 1; i <= 100; ++i)
    {
        accepted += SendGoto(static_cast<std::uint32_t>(i)) ? 1 : 0;
        auto message = std::make_shared<Uav::Goto>();
        message->id = static_cast<std::uint32_t>(1000 + i);
        accepted += twin.Workspace.AddMessageToQueue("uav1/MissionControl", message) ? 1 : 0;
        fleet.RunFor(50ms);
    }
    fleet.RunFor(10s);
    std::vector<int> taken = Take(mission);
    const Gateway::LinkStatus first = ground.LinkTo("uav1", "MissionControl");
    const Gateway::LinkStatus second = twin.LinkTo("uav1", "MissionControl");
    EXPECT_EQ(
        first.delivered + first.in_doubt + second.delivered + second.in_doubt + first.outbox + second.outbox,
        accepted);
    EXPECT_GE(taken.size(), first.delivered + second.delivered);
    std::sort(taken.begin(), taken.end());
    EXPECT_EQ(std::adjacent_find(taken.begin(), taken.end()), taken.end());
    EXPECT_THAT(ground.Problems() + twin.Problems(), HasSubstr("ground"));
}

TEST_F(QueueTest, AStarThatFindsAReceiverIsNoProblemAnyMore)
{
    auto message = std::make_shared<Uav::Pose>();
    EXPECT_FALSE(ground.Workspace.AddMessageToQueue("*/MissionControl", message));
    fleet.RunFor(1s);
    EXPECT_THAT(ground.Problems(), HasSubstr("send */MissionControl"));
    GatewayConfig config = AircraftConfig("uav2");
    config.Accept.front().Types = {"Uav::Pose"};
    fleet.Add(config).AddIdleManager("MissionControl");
    fleet.RunFor(3s);
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("*/MissionControl", message));
    fleet.RunFor(2s);
    EXPECT_THAT(ground.Problems(), Not(HasSubstr("send */MissionControl")));
}

TEST_F(QueueTest, AMessageOlderThanItsExpiryIsNeverDelivered)
{
    GatewayConfig config = GroundConfig();
    config.Node = "ground2";
    config.Send.push_back({.To = "uav*", .Expire = 5s});
    SimulatedNode &second = fleet.Add(config);
    fleet.RunFor(2s);
    SimulatedFaults cut;
    cut.Cut = true;
    fleet.Network.SetFaults("*", "*", cut);
    EXPECT_TRUE(second.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
    fleet.RunFor(15s);
    fleet.Network.ClearFaults();
    fleet.RunFor(15s);
    EXPECT_TRUE(Take(mission).empty());
    EXPECT_EQ(second.LinkTo("uav1", "MissionControl").expired, 1u);
}

TEST_F(QueueTest, ARestartedReceiverGetsWhatIsSentAfterwards)
{
    EXPECT_TRUE(SendGoto(1));
    fleet.RunFor(1s);
    fleet.Kill("uav1");
    fleet.RunFor(10s);
    SimulatedNode &again = fleet.Add(AircraftConfig("uav1"));
    IdleManager &manager = again.AddIdleManager("MissionControl");
    EXPECT_TRUE(fleet.RunUntil([&] { return ground.StateOf("uav1") == "UP"; }, 5s));
    EXPECT_TRUE(SendGoto(2));
    fleet.RunFor(5s);
    EXPECT_THAT(Take(manager), ElementsAre(2));
}

// Its bytes decode as the definition of the other node: longitude and latitude would be exchanged.
constexpr const char *OtherGoto = R"(module Uav {
@final struct Goto { unsigned long id; string<64> reply_to; double longitude_deg; double latitude_deg;
                     double altitude_m; float speed_mps; };
};
)";

TEST_F(QueueTest, MessagesThatWaitForANodeWithAnotherDefinitionOfTheirTypeAreRefusedAndHoldUpNoOther)
{
    // Types live as long as the process.
    static const std::shared_ptr<const DynamicType> other = DynamicType::Parse(OtherGoto, "Uav::Goto").Type;
    ASSERT_TRUE(other);
    auto former = std::make_unique<HandNode>(fleet.Network, "uav2", 7);
    fleet.RunFor(1s);
    Gateway::Announcement announcement;
    Gateway::AcceptedQueue &accepted = announcement.accepts.emplace_back();
    accepted.queue = "MissionControl";
    for (const MessageType *type :
         {static_cast<const MessageType *>(other.get()), &Uav::TargetReport::IdlType()})
    {
        Gateway::QueueType &taken = accepted.types.emplace_back();
        taken.type = type->Name();
        taken.definition = DefinitionHash(*type);
    }
    accepted.from.emplace_back("*");
    Gateway::Beat beat = former->Beat();
    Announce(beat, announcement);
    former->Write(beat);
    fleet.RunFor(200ms);

    const auto order = std::make_shared<RabitQueueReceipt>();
    const auto report = std::make_shared<RabitQueueReceipt>();
    auto target = std::make_shared<Uav::TargetReport>();
    target->target = 9;
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav2/MissionControl",
                                                   std::make_shared<DynamicMessage>(other), order));
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav2/MissionControl", target, report));
    former.reset();
    fleet.RunFor(10s);
    EXPECT_EQ(order->Outcome(), QueueOutcome::Pending);
    IdleManager &manager = fleet.Add(AircraftConfig("uav2")).AddIdleManager("MissionControl");
    fleet.RunFor(5s);

    EXPECT_THAT(Take(manager), ElementsAre(-9));
    EXPECT_EQ(order->Outcome(), QueueOutcome::Refused);
    EXPECT_EQ(report->Outcome(), QueueOutcome::Delivered);
    EXPECT_EQ(ground.LinkTo("uav2", "MissionControl").undeliverable, 1u);
    EXPECT_EQ(ground.LinkTo("uav2", "MissionControl").outbox, 0u);
    EXPECT_THAT(
        ground.Problems(),
        HasSubstr("send uav2/MissionControl: messages of `Uav::Goto` that waited for uav2 were refused "
                  "there"));
}

}  // namespace
}  // namespace Rabit
