#include <gtest/gtest.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitWorkspace.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "CapturedLog.h"
#include "SteppedFixture.h"
#include "TestMessages.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using RabitTest::NumberMessage;

std::shared_ptr<RabitQueueReceipt> NewReceipt()
{
    return std::make_shared<RabitQueueReceipt>();
}

TEST(RabitQueueReceipt, IsPendingUntilSomethingIsKnown)
{
    RabitQueueReceipt receipt;
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Pending);
    receipt.Begin();
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Pending);
    receipt.Settle(QueueOutcome::Delivered);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Delivered);
}

TEST(RabitQueueReceipt, OfSeveralMessagesIsPendingWhileOneIs)
{
    RabitQueueReceipt receipt;
    receipt.Begin(2);
    receipt.Settle(QueueOutcome::Delivered);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Pending);
    EXPECT_EQ(receipt.GetCounts().Pending, 1u);
    EXPECT_EQ(receipt.GetCounts().Delivered, 1u);
}

TEST(RabitQueueReceipt, OfSeveralMessagesTellsWhatWentWrongWithAny)
{
    RabitQueueReceipt receipt;
    receipt.Begin(3);
    receipt.Settle(QueueOutcome::Delivered);
    receipt.Settle(QueueOutcome::Refused);
    receipt.Settle(QueueOutcome::Delivered);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Refused);
    receipt.Begin();
    receipt.Settle(QueueOutcome::Expired);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Expired);
    receipt.Begin();
    receipt.Settle(QueueOutcome::InDoubt);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::InDoubt);
}

TEST(RabitQueueReceipt, CallsHandlersOnceWhenTheLastMessageIsSettled)
{
    RabitQueueReceipt receipt;
    int calls = 0;
    receipt.ConnectOutcomeKnown([&] { ++calls; });
    receipt.Begin(2);
    receipt.Settle(QueueOutcome::Delivered);
    EXPECT_EQ(calls, 0);
    receipt.Settle(QueueOutcome::Expired);
    EXPECT_EQ(calls, 1);
}

TEST(RabitQueueReceipt, CountsARefusalAtTheCallAndCallsNoHandler)
{
    RabitQueueReceipt receipt;
    int calls = 0;
    receipt.ConnectOutcomeKnown([&] { ++calls; });
    receipt.Begin();
    receipt.Refuse();
    EXPECT_EQ(calls, 0);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Refused);
    EXPECT_EQ(receipt.GetCounts().Refused, 1u);
    EXPECT_EQ(receipt.GetCounts().Pending, 0u);
    EXPECT_THROW(receipt.Refuse(), std::logic_error);
}

TEST(RabitQueueReceipt, TellsWhyTheLastRefusedMessageWasRefused)
{
    RabitQueueReceipt receipt;
    receipt.Begin(3);
    EXPECT_EQ(receipt.RefusalReason(), "");
    receipt.Refuse("first");
    receipt.Refuse("second");
    receipt.Settle(QueueOutcome::Delivered);
    EXPECT_EQ(receipt.RefusalReason(), "second");
}

TEST(RabitQueueReceipt, TellsWhyALocalQueueRefusedAMessage)
{
    RabitTest::CapturedLog log;
    RabitWorkspace workspace;
    const auto queue = std::make_shared<RabitMessageQueue<std::shared_ptr<RabitMessage>>>(1, "Small");
    workspace.AddManagerMessageQueue("Small", queue);
    const auto reasonOf = [&](const std::string &name, const std::shared_ptr<RabitMessage> &message)
    {
        const auto receipt = NewReceipt();
        workspace.AddMessageToQueue(name, message, receipt);
        return receipt->RefusalReason();
    };
    EXPECT_EQ(reasonOf("Small", std::make_shared<NumberMessage>()), "");
    EXPECT_EQ(reasonOf("Small", std::make_shared<NumberMessage>()), "the queue `Small` is full");
    EXPECT_EQ(reasonOf("Smal", std::make_shared<NumberMessage>()), "there is no queue `Smal`");
    EXPECT_EQ(reasonOf("Small", nullptr), "the message is a null pointer");
}

TEST(RabitQueueReceipt, CallsHandlersAtTheRefusalThatEndsAWaitForOtherMessages)
{
    RabitQueueReceipt receipt;
    int calls = 0;
    receipt.ConnectOutcomeKnown([&] { ++calls; });
    receipt.Begin(2);
    receipt.Settle(QueueOutcome::Delivered);
    receipt.Refuse();
    EXPECT_EQ(calls, 1);
    receipt.Begin();
    receipt.Refuse();
    EXPECT_EQ(calls, 1) << "nothing was settled since";
}

TEST(RabitQueueReceipt, CallsHandlersForTheOtherMessagesAfterARefusal)
{
    RabitQueueReceipt receipt;
    int calls = 0;
    receipt.ConnectOutcomeKnown([&] { ++calls; });
    receipt.Hold();
    receipt.Begin(2);
    receipt.Refuse();
    receipt.Release();
    EXPECT_EQ(calls, 0);
    receipt.Settle(QueueOutcome::Delivered);
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Refused);
}

TEST(RabitQueueReceipt, ItsHandlersMayAskItAndAddToIt)
{
    RabitQueueReceipt receipt;
    QueueOutcome seen = QueueOutcome::Pending;
    receipt.ConnectOutcomeKnown(
        [&]
        {
            seen = receipt.Outcome();
            receipt.Begin();
        });
    receipt.Begin();
    receipt.Settle(QueueOutcome::Delivered);
    EXPECT_EQ(seen, QueueOutcome::Delivered);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Pending);
}

TEST(RabitQueueReceipt, CannotBeSettledMoreOftenThanBegunOrAsPending)
{
    RabitQueueReceipt receipt;
    EXPECT_THROW(receipt.Settle(QueueOutcome::Delivered), std::logic_error);
    receipt.Begin();
    EXPECT_THROW(receipt.Settle(QueueOutcome::Pending), std::invalid_argument);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Pending);
}

TEST(RabitQueueReceipt, SettledFromManyThreadsCountsAll)
{
    RabitQueueReceipt receipt;
    int calls = 0;  // only the last one settled calls
    receipt.ConnectOutcomeKnown([&] { ++calls; });
    receipt.Begin(4000);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
    {
        threads.emplace_back(
            [&receipt]
            {
                for (int n = 0; n < 1000; ++n)
                {
                    receipt.Settle(QueueOutcome::Delivered);
                }
            });
    }
    for (std::thread &thread : threads)
    {
        thread.join();
    }
    EXPECT_EQ(receipt.GetCounts().Delivered, 4000u);
    EXPECT_EQ(calls, 1);
}

class LocalReceiptTest : public ::testing::Test
{
protected:
    using Queue = RabitMessageQueue<int>;
    LocalReceiptTest() { workspace.AddManagerMessageQueue("numbers", std::make_shared<Queue>(1, "numbers")); }
    RabitWorkspace workspace;
};

TEST_F(LocalReceiptTest, AMessageInALocalQueueIsDeliveredAtOnce)
{
    const auto receipt = NewReceipt();
    EXPECT_TRUE(workspace.AddMessageToQueue("numbers", 1, receipt));
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Delivered);
}

TEST_F(LocalReceiptTest, AFullLocalQueueIsARefusal)
{
    workspace.AddMessageToQueue("numbers", 1);
    const auto receipt = NewReceipt();
    EXPECT_FALSE(workspace.AddMessageToQueue("numbers", 2, receipt));
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Refused);
}

TEST_F(LocalReceiptTest, AnUnknownQueueIsARefusal)
{
    const auto numbers = NewReceipt();
    EXPECT_FALSE(workspace.AddMessageToQueue("nothing", 2, numbers));
    EXPECT_EQ(numbers->Outcome(), QueueOutcome::Refused);
    const auto messages = NewReceipt();
    EXPECT_FALSE(workspace.AddMessageToQueue("nothing", std::make_shared<NumberMessage>(), messages));
    EXPECT_EQ(messages->Outcome(), QueueOutcome::Refused);
}

TEST_F(LocalReceiptTest, AWrongTypeThrowsAndTellsNothing)
{
    const auto receipt = NewReceipt();
    EXPECT_THROW(workspace.AddMessageToQueue("numbers", std::string("x"), receipt), QueueTypeException);
    EXPECT_EQ(receipt->GetCounts().Refused, 0u);
}

TEST(RabitQueueReceiptWakeup, WakesTheManagerOnceAllIsKnown)
{
    RabitTest::SteppedFixture fixture;
    RabitTest::ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelaySec(3600);
    const auto receipt = NewReceipt();
    manager.WakeUpManagerOnOutcome(receipt);
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    const int before = manager.Passes.load();
    receipt->Begin(2);
    receipt->Settle(QueueOutcome::Delivered);
    fixture.RunFor(1s);
    EXPECT_EQ(manager.Passes.load(), before);
    receipt->Settle(QueueOutcome::Delivered);
    fixture.RunFor(1s);
    EXPECT_EQ(manager.Passes.load(), before + 1);
}

TEST(RabitQueueReceiptWakeup, AMessageThatIsRefusedAtTheCallWakesNobody)
{
    RabitTest::SteppedFixture fixture;
    RabitTest::ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelaySec(3600);
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    const int before = manager.Passes.load();
    const auto receipt = NewReceipt();
    manager.WakeUpManagerOnOutcome(receipt);
    EXPECT_FALSE(manager.AddMessageToQueue("nothing", std::make_shared<NumberMessage>(), receipt));
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Refused);
    fixture.RunFor(1s);
    EXPECT_EQ(manager.Passes.load(), before);
}

TEST(RabitQueueReceiptWakeup, OutlivesItsManager)
{
    RabitWorkspace workspace;
    const auto receipt = NewReceipt();
    {
        RabitTest::ScriptedManager manager("Manager", workspace);
        manager.WakeUpManagerOnOutcome(receipt);
    }
    receipt->Begin();
    receipt->Settle(QueueOutcome::Expired);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Expired);
}

TEST(RabitQueueReceiptWakeup, NeedsAReceipt)
{
    RabitWorkspace workspace;
    RabitTest::ScriptedManager manager("Manager", workspace);
    EXPECT_THROW(manager.WakeUpManagerOnOutcome(nullptr), std::invalid_argument);
}

TEST(RabitQueueReceipt, IsNotKnownWhileItIsHeld)
{
    RabitQueueReceipt receipt;
    int known = 0;
    const RabitConnection connection = receipt.ConnectOutcomeKnown([&known] { ++known; });
    receipt.Hold();
    for (int i = 0; i < 2; ++i)
    {
        receipt.Begin();
        receipt.Settle(QueueOutcome::Delivered);
        EXPECT_EQ(receipt.Outcome(), QueueOutcome::Pending);
    }
    EXPECT_EQ(known, 0);
    receipt.Release();
    EXPECT_EQ(known, 1);
    EXPECT_EQ(receipt.Outcome(), QueueOutcome::Delivered);
    EXPECT_THROW(receipt.Release(), std::logic_error);
    receipt.Hold();
    receipt.Release();
    EXPECT_EQ(known, 1) << "nothing was settled";
}

}  // namespace
}  // namespace Rabit
