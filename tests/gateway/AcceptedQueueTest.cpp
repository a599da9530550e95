#include "queues/AcceptedQueue.h"

#include <gtest/gtest.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <vector>

#include "names/TypeDefinition.h"
#include "uav.idl.h"

namespace Rabit
{
namespace
{

class AcceptedQueueTest : public ::testing::Test
{
protected:
    AcceptedQueueTest() : accepted(Rule(), workspace, [this] { ++wakes; }) {}

    static AcceptRule Rule()
    {
        AcceptRule rule;
        rule.Queue = "Orders";
        rule.Types = {"Uav::Goto"};
        return rule;
    }

    void AddLocal(int capacity)
    {
        local = std::make_shared<AcceptedQueue::Queue>(capacity, "Orders");
        workspace.AddManagerMessageQueue("Orders", local);
        accepted.Find();
    }

    AcceptedQueue::Decoded Goto() const
    {
        const Uav::Goto message;
        const MessageType &type = *MessageTypeRegistry::Of(message);
        std::vector<std::uint8_t> bytes(type.SerializedSize(message));
        type.Serialize(message, bytes);
        return accepted.Decode(LinkTypeName(type), bytes);
    }

    void Take()
    {
        std::shared_ptr<RabitMessage> taken;
        EXPECT_TRUE(local->GetMessage(taken));
    }

    RabitWorkspace workspace;
    int wakes = 0;
    std::shared_ptr<AcceptedQueue::Queue> local;
    AcceptedQueue accepted;
};

TEST_F(AcceptedQueueTest, TellsOfRoomAfterItWasSaidToBeExactlyFull)
{
    AddLocal(2);
    EXPECT_EQ(accepted.Room(), 2u);
    EXPECT_EQ(accepted.Deliver(Goto(), false), LocalQueueResult::Ok);
    EXPECT_EQ(accepted.Deliver(Goto(), false), LocalQueueResult::Ok);
    EXPECT_EQ(accepted.Room(), 0u);
    EXPECT_FALSE(accepted.TakeRoomCame());
    Take();
    EXPECT_EQ(wakes, 1);
    EXPECT_TRUE(accepted.TakeRoomCame());
    EXPECT_EQ(accepted.Room(), 1u);
}

TEST_F(AcceptedQueueTest, TellsOfRoomAfterAMessageDidNotFit)
{
    AddLocal(1);
    EXPECT_EQ(accepted.Deliver(Goto(), false), LocalQueueResult::Ok);
    EXPECT_EQ(accepted.Deliver(Goto(), false), LocalQueueResult::Full);
    Take();
    EXPECT_EQ(wakes, 1);
    EXPECT_TRUE(accepted.TakeRoomCame());
}

TEST_F(AcceptedQueueTest, DoesNotWakeTheGatewayForEachMessageTakenWhileThereIsRoom)
{
    AddLocal(3);
    EXPECT_EQ(accepted.Deliver(Goto(), false), LocalQueueResult::Ok);
    EXPECT_GT(accepted.Room(), 0u);
    Take();
    EXPECT_EQ(wakes, 0);
    EXPECT_FALSE(accepted.TakeRoomCame());
}

TEST_F(AcceptedQueueTest, HoldsTheStreamBackWhileThereIsNoQueue)
{
    accepted.Find();
    EXPECT_EQ(accepted.Deliver(Goto(), false), LocalQueueResult::Full);
    EXPECT_EQ(accepted.Room(), 0u);
    EXPECT_EQ(accepted.Problem(), "there is no local queue `Orders`");
}

TEST_F(AcceptedQueueTest, KeepsTheQueueThatAMessageWentIntoAfterItsManagerHasGone)
{
    AddLocal(1);
    EXPECT_EQ(accepted.Deliver(Goto(), false), LocalQueueResult::Ok);
    const std::shared_ptr<AcceptedQueue::Queue> delivered = accepted.Local();
    AddLocal(1);
    EXPECT_NE(accepted.Local(), delivered);
    EXPECT_EQ(delivered->NoMessagesInQueue(), 1);
}

// Between two looks of the gateway's thread.
TEST_F(AcceptedQueueTest, PutsNoMessageIntoAQueueThatWasReplaced)
{
    AddLocal(1);
    const std::shared_ptr<AcceptedQueue::Queue> former = local;
    local = std::make_shared<AcceptedQueue::Queue>(1, "Orders");
    workspace.AddManagerMessageQueue("Orders", local);
    EXPECT_EQ(accepted.Deliver(Goto(), false), LocalQueueResult::Ok);
    EXPECT_EQ(former->NoMessagesInQueue(), 0);
    EXPECT_EQ(local->NoMessagesInQueue(), 1);
    EXPECT_EQ(accepted.Local(), local);
    EXPECT_TRUE(accepted.TakeRoomCame()) << "other links may wait for the new queue";
}

TEST_F(AcceptedQueueTest, TellsATypeThatIsNotTakenFromBytesThatAreNoMessage)
{
    AddLocal(1);
    const std::vector<std::uint8_t> rubbish{1, 2, 3};
    EXPECT_EQ(accepted.Deliver(accepted.Decode("Uav::Pose", rubbish), false), LocalQueueResult::WrongType);
    EXPECT_EQ(accepted.Deliver(accepted.Decode(LinkTypeName(Uav::Goto::IdlType()), rubbish), false),
              LocalQueueResult::Undecodable);
    EXPECT_EQ(local->NoMessagesInQueue(), 0);
}

TEST_F(AcceptedQueueTest, MarksWhatComesAgain)
{
    AddLocal(1);
    EXPECT_EQ(accepted.Deliver(Goto(), true), LocalQueueResult::Ok);
    std::shared_ptr<RabitMessage> taken;
    ASSERT_TRUE(local->GetMessage(taken));
    EXPECT_TRUE(taken->IsRedelivered());
}

}  // namespace
}  // namespace Rabit
