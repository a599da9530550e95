#include "CapturedLog.h"
#include "TestMessages.h"
#include "TypedMessages.h"

#include <rabit/RabitWorkspace.h>

#include <gtest/gtest.h>

#include <any>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;

using MessageQueue = RabitMessageQueue<std::shared_ptr<RabitMessage>>;

TEST(RabitWorkspace, TheDefaultOneIsAlwaysTheSame)
{
    EXPECT_EQ(RabitWorkspace::GetWorkspace(), RabitWorkspace::GetWorkspace());
}

TEST(RabitWorkspaceMessages, TheFirstRegistrationMakesTheGlobalCopyAndLaterOnesAttachToIt)
{
    RabitWorkspace workspace;
    const auto first = std::make_shared<NumberMessage>();
    first->Number = 5;
    const auto second = std::make_shared<NumberMessage>();
    EXPECT_TRUE(workspace.AddPublishSubscribeMessage("Name", first));
    EXPECT_TRUE(workspace.AddPublishSubscribeMessage("Name", second));
    EXPECT_EQ(first->GetGlobalPublishSubscribeMessageRef(), second->GetGlobalPublishSubscribeMessageRef());
    EXPECT_EQ(static_cast<NumberMessage &>(*workspace.GetMessage("Name")).Number, 5);
}

TEST(RabitWorkspaceMessages, AMessageOfAnotherTypeIsLeftUnattachedAndSaidSo)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    const auto other = std::make_shared<AssigningMessage>();
    workspace.AddPublishSubscribeMessage("Name", std::make_shared<NumberMessage>());
    EXPECT_FALSE(workspace.AddPublishSubscribeMessage("Name", other));
    EXPECT_EQ(other->GetGlobalPublishSubscribeMessageRef(), nullptr);
    EXPECT_EQ(log.Lines().size(), 1u);
}

TEST(RabitWorkspaceMessages, AClassOfSeveralTypesIsAttachedToItsOwnTypeAlone)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    const auto other = std::make_shared<ManyTypedMessage>("other");
    workspace.AddPublishSubscribeMessage("Name", std::make_shared<ManyTypedMessage>("one"));
    EXPECT_TRUE(workspace.AddPublishSubscribeMessage("Name", std::make_shared<ManyTypedMessage>("one")));
    EXPECT_FALSE(workspace.AddPublishSubscribeMessage("Name", other));
    EXPECT_EQ(other->GetGlobalPublishSubscribeMessageRef(), nullptr);
    EXPECT_EQ(log.Lines().size(), 1u);
}

TEST(RabitWorkspaceMessages, AnOverrideThatReturnsFalseForItsOwnTypeIsAttached)
{
    RabitWorkspace workspace;
    workspace.AddPublishSubscribeMessage("Name", std::make_shared<DenyingMessage>());
    EXPECT_TRUE(workspace.AddPublishSubscribeMessage("Name", std::make_shared<DenyingMessage>()));
}

TEST(RabitWorkspaceMessages, RegisteringTellsWhatHappened)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    const auto message = std::make_shared<NumberMessage>();
    const MessageRegistration made = workspace.RegisterMessage("Name", message);
    EXPECT_EQ(made.Result, MessageRegistrationResult::Created);
    EXPECT_EQ(workspace.RegisterMessage("Name", std::make_shared<NumberMessage>()).Result,
              MessageRegistrationResult::Attached);
    const MessageRegistration refused =
        workspace.RegisterMessage("Name", std::make_shared<AssigningMessage>());
    EXPECT_EQ(refused.Result, MessageRegistrationResult::OtherType);
    EXPECT_EQ(refused.Global, made.Global);
    EXPECT_EQ(workspace.FindGlobalMessage("Name"), made.Global);
    EXPECT_EQ(workspace.FindGlobalMessage("Other"), nullptr);
    EXPECT_THROW(workspace.RegisterMessage("Name", nullptr), std::invalid_argument);
}

TEST(RabitWorkspaceMessages, AreFetchedByName)
{
    RabitWorkspace workspace;
    const auto poster = std::make_shared<NumberMessage>();
    workspace.AddPublishSubscribeMessage("Name", poster);
    poster->Number = 3;
    poster->PostMessage();
    NumberMessage target;
    EXPECT_TRUE(workspace.FetchMessage("Name", &target));
    EXPECT_EQ(target.Number, 3);
    EXPECT_FALSE(workspace.FetchMessage("Name", &target));
    EXPECT_TRUE(workspace.ForceFetchMessage("Name", &target));
}

TEST(RabitWorkspaceMessages, OfAnUnknownNameAreNotFetched)
{
    RabitWorkspace workspace;
    NumberMessage target;
    EXPECT_FALSE(workspace.FetchMessage("Nobody", &target));
    EXPECT_FALSE(workspace.ForceFetchMessage("Nobody", &target));
    EXPECT_EQ(workspace.GetMessage("Nobody"), nullptr);
}

TEST(RabitWorkspaceMessages, AreListedWithTheirTypes)
{
    RabitWorkspace workspace;
    const auto second = std::make_shared<AssigningMessage>();
    workspace.AddPublishSubscribeMessage("B", second);
    workspace.AddPublishSubscribeMessage("A", std::make_shared<NumberMessage>());
    second->PostMessage();
    const auto list = workspace.GetListOfMessages();
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].Name, "A");
    EXPECT_EQ(list[0].Type, std::type_index(typeid(NumberMessage)));
    EXPECT_EQ(list[1].Name, "B");
    EXPECT_EQ(list[1].NumberOfPosts, 1u);
}

TEST(RabitWorkspaceMessages, StayUsableWhenTheirNamesAreForgotten)
{
    RabitWorkspace workspace;
    const auto message = std::make_shared<NumberMessage>();
    workspace.AddPublishSubscribeMessage("Name", message);
    workspace.LeavingReactor();
    EXPECT_EQ(workspace.FindGlobalMessage("Name"), nullptr);
    message->PostMessage();
    EXPECT_FALSE(message->FetchMessage());
}

TEST(RabitWorkspaceQueues, AreFoundByNameAndType)
{
    RabitWorkspace workspace;
    const auto queue = std::make_shared<RabitMessageQueue<int>>(10, "Queue");
    workspace.AddManagerMessageQueue("Queue", queue);
    EXPECT_EQ(workspace.GetManagerMessageQueue<std::shared_ptr<RabitMessageQueue<int>>>("Queue"), queue);
    EXPECT_THROW(workspace.GetManagerMessageQueue<std::shared_ptr<RabitMessageQueue<int>>>("Other"),
                 MessageNotRegisteredException);
    EXPECT_THROW(workspace.GetManagerMessageQueue<std::shared_ptr<RabitMessageQueue<double>>>("Queue"),
                 std::bad_any_cast);
    EXPECT_THROW(workspace.GetManagerMessageQueue<std::shared_ptr<RabitNonBlockingSPSCQueue<int>>>("Queue"),
                 QueueTypeException);
}

TEST(RabitWorkspaceQueues, RegisteringReplacesAFormerQueueOfThatName)
{
    RabitWorkspace workspace;
    workspace.AddManagerMessageQueue("Queue", std::make_shared<RabitMessageQueue<int>>(10, "First"));
    workspace.AddManagerMessageQueue("Queue",
                                     std::make_shared<RabitNonBlockingSPSCQueue<double>>(7, "Second"));
    const auto list = workspace.GetListOfQueues();
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].Name, "Queue");
    EXPECT_EQ(list[0].Capacity, 7);
    EXPECT_EQ(list[0].ElementType, std::type_index(typeid(double)));
}

TEST(RabitWorkspaceQueues, AreListedWithTheirFillLevelAndWhatTheyRefused)
{
    RabitWorkspace workspace;
    workspace.AddManagerMessageQueue("Many", std::make_shared<RabitMessageQueue<int>>(2, "Many"));
    workspace.AddManagerMessageQueue("Single", std::make_shared<RabitNonBlockingSPSCQueue<int>>(1, "Single"));
    for (int i = 0; i < 3; ++i)
    {
        workspace.AddMessageToQueue("Many", i);
        workspace.AddMessageToQueue("Single", i);
    }
    const auto list = workspace.GetListOfQueues();
    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0].FillLevel, 2);
    EXPECT_EQ(list[0].RefusedAdds, 1U);
    EXPECT_EQ(list[1].FillLevel, 1);
    EXPECT_EQ(list[1].RefusedAdds, 2U);
}

TEST(RabitWorkspaceQueues, TakeMessagesByName)
{
    RabitWorkspace workspace;
    const auto queue = std::make_shared<RabitMessageQueue<int>>(1, "Queue");
    workspace.AddManagerMessageQueue("Queue", queue);
    EXPECT_TRUE(workspace.AddMessageToQueue("Queue", 5));
    int message = 0;
    queue->GetMessage(message);
    EXPECT_EQ(message, 5);
}

TEST(RabitWorkspaceQueues, AnUnknownNameOrAFullQueueGivesFalse)
{
    RabitWorkspace workspace;
    workspace.AddManagerMessageQueue("Queue", std::make_shared<RabitMessageQueue<int>>(1, "Queue"));
    EXPECT_FALSE(workspace.AddMessageToQueue("Other", 5));
    EXPECT_TRUE(workspace.AddMessageToQueue("Queue", 5));
    EXPECT_FALSE(workspace.AddMessageToQueue("Queue", 6));
}

TEST(RabitWorkspaceQueues, ANullMessageIsRefusedByALocalQueueAsByARemoteOne)
{
    RabitWorkspace workspace;
    const auto queue = std::make_shared<MessageQueue>(5, "Queue");
    const auto typed = std::make_shared<RabitMessageQueue<std::shared_ptr<NumberMessage>>>(5, "Typed");
    workspace.AddManagerMessageQueue("Queue", queue);
    workspace.AddManagerMessageQueue("Typed", typed);
    for (const char *name : {"Queue", "Typed", "Unknown"})
    {
        const auto receipt = std::make_shared<RabitQueueReceipt>();
        EXPECT_FALSE(workspace.AddMessageToQueue(name, std::shared_ptr<NumberMessage>(), receipt)) << name;
        EXPECT_EQ(receipt->Outcome(), QueueOutcome::Refused) << name;
        EXPECT_FALSE(workspace.AddMessageToQueue(name, std::shared_ptr<RabitMessage>())) << name;
    }
    EXPECT_TRUE(queue->IsEmpty());
    EXPECT_TRUE(typed->IsEmpty());
}

TEST(RabitWorkspaceQueues, AnElementOfAnotherTypeThrowsAClearException)
{
    RabitWorkspace workspace;
    workspace.AddManagerMessageQueue("Queue", std::make_shared<RabitMessageQueue<int>>(1, "Queue"));
    try
    {
        workspace.AddMessageToQueue("Queue", std::string("text"));
        FAIL() << "no exception";
    }
    catch (const std::exception &exception)
    {
        EXPECT_NE(std::string(exception.what()).find("\"Queue\""), std::string::npos) << exception.what();
        EXPECT_NE(std::string(exception.what()).find("int"), std::string::npos) << exception.what();
    }
}

TEST(RabitWorkspaceQueues, OfTheBaseTakePointersToDerivedMessages)
{
    RabitWorkspace workspace;
    const auto queue = std::make_shared<MessageQueue>(10, "Queue");
    workspace.AddManagerMessageQueue("Queue", queue);
    const auto message = std::make_shared<NumberMessage>();
    EXPECT_TRUE(workspace.AddMessageToQueue("Queue", message));
    EXPECT_TRUE(workspace.AddMessageToQueue("Queue", message->Clone()));
    std::shared_ptr<RabitMessage> taken;
    ASSERT_TRUE(queue->GetMessage(taken));
    EXPECT_EQ(taken, message);
    ASSERT_TRUE(queue->GetMessage(taken));
    EXPECT_NE(dynamic_cast<NumberMessage *>(taken.get()), nullptr);
}

TEST(RabitWorkspaceQueues, OfADerivedMessageTakeWhatIsOneOnly)
{
    RabitWorkspace workspace;
    workspace.AddManagerMessageQueue(
        "Queue", std::make_shared<RabitMessageQueue<std::shared_ptr<NumberMessage>>>(10, "Queue"));
    const std::shared_ptr<RabitMessage> number = std::make_shared<NumberMessage>();
    const std::shared_ptr<RabitMessage> other = std::make_shared<AssigningMessage>();
    EXPECT_TRUE(workspace.AddMessageToQueue("Queue", number));
    EXPECT_THROW(workspace.AddMessageToQueue("Queue", other), QueueTypeException);
}

struct Shape
{
    virtual ~Shape() = default;
};
struct Named
{
    std::string Name;
};
struct Circle : Named, Shape
{
};

TEST(RabitWorkspaceQueues, OfAnyBaseTakePointersToItsDerivedClasses)
{
    RabitWorkspace workspace;
    const auto queue = std::make_shared<RabitMessageQueue<std::shared_ptr<Shape>>>(10, "Queue");
    workspace.AddManagerMessageQueue("Queue", queue);
    const auto circle = std::make_shared<Circle>();
    EXPECT_TRUE(workspace.AddMessageToQueue("Queue", circle));
    EXPECT_THROW(workspace.AddMessageToQueue("Queue", std::make_shared<Named>()), QueueTypeException);
    std::shared_ptr<Shape> taken;
    ASSERT_TRUE(queue->GetMessage(taken));
    EXPECT_EQ(taken, circle);
}

TEST(RabitWorkspaceQueues, OfStringsTakeLiterals)
{
    RabitWorkspace workspace;
    const auto queue = std::make_shared<RabitMessageQueue<std::string>>(10, "Queue");
    workspace.AddManagerMessageQueue("Queue", queue);
    EXPECT_TRUE(workspace.AddMessageToQueue("Queue", "literal"));
    std::string taken;
    ASSERT_TRUE(queue->GetMessage(taken));
    EXPECT_EQ(taken, "literal");
    EXPECT_THROW(workspace.AddMessageToQueue("Queue", 5), QueueTypeException);
}

TEST(RabitWorkspaceQueues, TellOfTheirEventsByName)
{
    RabitWorkspace workspace;
    const auto queue = std::make_shared<RabitMessageQueue<int>>(10, "Queue");
    workspace.AddManagerMessageQueue("Queue", queue);
    int enqueued = 0;
    int dequeued = 0;
    EXPECT_TRUE(workspace.Register_EnqueuedEvent<int>("Queue", [&] { ++enqueued; }));
    EXPECT_TRUE(workspace.Register_DequeuedEvent<int>("Queue", [&] { ++dequeued; }));
    queue->AddMessage(1);
    int message = 0;
    queue->GetMessage(message);
    EXPECT_EQ(enqueued, 1);
    EXPECT_EQ(dequeued, 1);
    EXPECT_THROW(workspace.Register_EnqueuedEvent<int>("Other", [] {}), MessageNotRegisteredException);
    EXPECT_THROW(workspace.Register_DequeuedEvent<int>("Other", [] {}), MessageNotRegisteredException);
    RabitConnection connection = workspace.ConnectEnqueuedEvent("Queue", [&] { ++enqueued; });
    connection.Disconnect();
    queue->AddMessage(1);
    EXPECT_EQ(enqueued, 2);
    EXPECT_FALSE(workspace.ConnectDequeuedEvent("Other", [] {}).IsConnected());
}

TEST(RabitWorkspaceQueues, AreDeliveredToByNameAloneWithAReason)
{
    RabitWorkspace workspace;
    const auto message = std::make_shared<NumberMessage>();
    workspace.AddManagerMessageQueue("Base", std::make_shared<MessageQueue>(1, "Base"));
    workspace.AddManagerMessageQueue(
        "Other", std::make_shared<RabitMessageQueue<std::shared_ptr<AssigningMessage>>>(1, "Other"));
    workspace.AddManagerMessageQueue("Ints", std::make_shared<RabitMessageQueue<int>>(1, "Ints"));
    EXPECT_EQ(workspace.DeliverToQueue("Base", message), QueueAddResult::Ok);
    EXPECT_EQ(workspace.DeliverToQueue("Base", message), QueueAddResult::Full);
    EXPECT_EQ(workspace.DeliverToQueue("Other", message), QueueAddResult::WrongType);
    EXPECT_EQ(workspace.DeliverToQueue("Ints", message), QueueAddResult::WrongType);
    EXPECT_EQ(workspace.DeliverToQueue("Nobody", message), QueueAddResult::UnknownQueue);
}

// Accepts messages addressed to "far/...".
class FarForwarder : public QueueForwarder
{
public:
    bool Handles(const std::string &queueName) const override { return queueName.rfind("far/", 0) == 0; }
    bool Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                 const std::shared_ptr<RabitQueueReceipt> &) override
    {
        Names.push_back(queueName);
        Messages.push_back(message);
        return Accept;
    }
    bool Accept = true;
    std::vector<std::string> Names;
    std::vector<std::shared_ptr<RabitMessage>> Messages;
};

TEST(QueueForwarder, TakesMessagesForQueuesThatAreNotHere)
{
    RabitWorkspace workspace;
    const auto forwarder = std::make_shared<FarForwarder>();
    workspace.SetQueueForwarder(forwarder);
    const auto message = std::make_shared<NumberMessage>();
    EXPECT_TRUE(workspace.AddMessageToQueue("far/Queue", message));
    forwarder->Accept = false;
    EXPECT_FALSE(workspace.AddMessageToQueue("far/Queue", message));
    EXPECT_EQ(forwarder->Names, (std::vector<std::string>{"far/Queue", "far/Queue"}));
    EXPECT_EQ(forwarder->Messages[0], message);
}

TEST(QueueForwarder, IsAskedForNothingElse)
{
    RabitWorkspace workspace;
    const auto forwarder = std::make_shared<FarForwarder>();
    workspace.SetQueueForwarder(forwarder);
    workspace.AddManagerMessageQueue("far/Local", std::make_shared<MessageQueue>(10, "Local"));
    const auto message = std::make_shared<NumberMessage>();
    EXPECT_TRUE(workspace.AddMessageToQueue("far/Local", message));  // a queue of that name is here
    EXPECT_FALSE(workspace.AddMessageToQueue("near", message));      // it does not handle this name
    EXPECT_FALSE(workspace.AddMessageToQueue("far/Queue", 5));       // not a message
    EXPECT_FALSE(workspace.AddMessageToQueue("far/Queue", std::shared_ptr<RabitMessage>()));
    EXPECT_EQ(workspace.DeliverToQueue("far/Queue", message), QueueAddResult::UnknownQueue);
    workspace.SetQueueForwarder(nullptr);
    EXPECT_FALSE(workspace.AddMessageToQueue("far/Queue", message));
    EXPECT_TRUE(forwarder->Names.empty());
}

TEST(QueueForwarder, IsOutOfUseWhenItWasCleared)
{
    // Holds a call until the test lets it go on.
    class Slow : public QueueForwarder
    {
    public:
        bool Handles(const std::string &) const override { return true; }
        bool Forward(const std::string &, const std::shared_ptr<RabitMessage> &,
                     const std::shared_ptr<RabitQueueReceipt> &) override
        {
            std::unique_lock<std::mutex> lock(Mutex);
            Entered = true;
            Changed.notify_all();
            Changed.wait(lock, [&] { return GoOn; });
            Left = true;
            return true;
        }
        std::mutex Mutex;
        std::condition_variable Changed;
        bool Entered = false;
        bool GoOn = false;
        bool Left = false;
    };
    RabitWorkspace workspace;
    const auto slow = std::make_shared<Slow>();
    workspace.SetQueueForwarder(slow);
    std::thread adding([&] { workspace.AddMessageToQueue("far", std::make_shared<NumberMessage>()); });
    {
        std::unique_lock<std::mutex> lock(slow->Mutex);
        slow->Changed.wait(lock, [&] { return slow->Entered; });
    }
    std::atomic<bool> leftBeforeCleared{false};
    std::thread clearing(
        [&]
        {
            workspace.SetQueueForwarder(nullptr);
            const std::lock_guard<std::mutex> lock(slow->Mutex);
            leftBeforeCleared = slow->Left;
        });
    {
        const std::lock_guard<std::mutex> lock(slow->Mutex);
        slow->GoOn = true;
        slow->Changed.notify_all();
    }
    clearing.join();
    adding.join();
    EXPECT_TRUE(leftBeforeCleared);
}

TEST(RabitWorkspace, NamesMayBeRegisteredAndUsedFromManyThreadsAtOnce)
{
    RabitWorkspace workspace;
    std::vector<std::thread> threads;
    std::atomic<int> attached{0};
    for (int t = 0; t < 4; ++t)
    {
        threads.emplace_back(
            [&, t]
            {
                for (int i = 0; i < 200; ++i)
                {
                    const std::string name = "Name" + std::to_string(i);
                    const auto message = std::make_shared<NumberMessage>();
                    attached += workspace.AddPublishSubscribeMessage(name, message) ? 1 : 0;
                    message->Number = t;
                    message->PostMessage();
                    workspace.AddManagerMessageQueue(name,
                                                     std::make_shared<RabitMessageQueue<int>>(10, name));
                    workspace.AddMessageToQueue(name, i);
                    workspace.GetListOfMessages();
                }
            });
    }
    for (std::thread &thread : threads)
    {
        thread.join();
    }
    EXPECT_EQ(attached, 800);
    const auto list = workspace.GetListOfMessages();
    ASSERT_EQ(list.size(), 200u);
    for (const MessageInfo &message : list)
    {
        EXPECT_EQ(message.NumberOfPosts, 4u) << message.Name;
    }
}

}  // namespace
