#include "SteppedFixture.h"
#include "TestMessages.h"

#include <rabit/GlobalPublishSubscribeException.h>

#include <boost/bind/bind.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

// A manager that only events wake, after its first pass.
struct SleepingFixture : SteppedFixture
{
    ScriptedManager &Manager = Add("Manager");
    std::shared_ptr<NumberMessage> Message = std::make_shared<NumberMessage>();
    std::shared_ptr<RabitMessageQueue<int>> Queue = std::make_shared<RabitMessageQueue<int>>(10, "Queue");

    SleepingFixture()
    {
        Manager.SetWakeupTimeDelaySec(1e6);
        Manager.AddPublishSubscribeMessage("Message", Message);
        Manager.AddManagerMessageQueue("Queue", Queue);
        Reactor.Start();
        RunFor(1s);
    }
    // Returns the number of passes that `cause` leads to.
    template <typename Cause>
    int PassesCausedBy(Cause cause)
    {
        const int before = Manager.Passes;
        cause();
        RunFor(1s);
        return Manager.Passes - before;
    }
};

TEST(ManagerWakeup, HappensOnAPostOfAChosenMessageAndOfNoOther)
{
    SleepingFixture fixture;
    const auto post = [&] { fixture.Message->PostMessage(); };
    EXPECT_EQ(fixture.PassesCausedBy(post), 0);
    fixture.Manager.WakeUpManagerOnMessagePost(fixture.Message);
    EXPECT_EQ(fixture.PassesCausedBy(post), 1);
}

TEST(ManagerWakeup, HappensOnEnqueueAndOnDequeueOfAChosenQueue)
{
    SleepingFixture fixture;
    const auto enqueue = [&] { fixture.Queue->AddMessage(1); };
    int taken = 0;
    const auto dequeue = [&] { fixture.Queue->GetMessage(taken); };
    EXPECT_EQ(fixture.PassesCausedBy(enqueue), 0);
    EXPECT_EQ(fixture.PassesCausedBy(dequeue), 0);
    fixture.Manager.WakeUpManagerOnEnqueue(fixture.Queue);
    EXPECT_EQ(fixture.PassesCausedBy(enqueue), 1);
    EXPECT_EQ(fixture.PassesCausedBy(dequeue), 0);
    fixture.Manager.WakeUpManagerOnDequeue(fixture.Queue);
    fixture.PassesCausedBy(enqueue);
    EXPECT_EQ(fixture.PassesCausedBy(dequeue), 1);
    EXPECT_EQ(fixture.PassesCausedBy(dequeue), 0);  // the queue was empty
}

TEST(ManagerWakeup, HappensOnAMessageToTheManagersOwnQueueByName)
{
    SleepingFixture fixture;
    const auto add = [&] { fixture.Workspace.AddMessageToQueue("Manager", fixture.Message); };
    EXPECT_EQ(fixture.PassesCausedBy(add), 1);
    EXPECT_EQ(fixture.Manager.GetManagerMessageQueue()->NoMessagesInQueue(), 1);
    EXPECT_EQ(fixture.Manager.GetManagerMessageQueue()->GetMaxNoMessagesAllowedInQueue(), 1000);
}

TEST(ManagerWakeup, ByTheOwnQueueCanBeSwitchedOffAndOn)
{
    SleepingFixture fixture;
    const auto add = [&] { fixture.Workspace.AddMessageToQueue("Manager", fixture.Message); };
    fixture.Manager.SetWakeupManagerUponMessagePostedToManagersMessageQueue(false);
    EXPECT_EQ(fixture.PassesCausedBy(add), 0);
    fixture.Manager.SetWakeupManagerUponMessagePostedToManagersMessageQueue();
    EXPECT_EQ(fixture.PassesCausedBy(add), 1);
}

TEST(ManagerWakeup, HappensOnACallFromAnyHandler)
{
    SleepingFixture fixture;
    fixture.Queue->Register_SomethingDequeued(boost::bind(&RabitManager::WakeUpManagerEH, &fixture.Manager));
    int taken = 0;
    fixture.Queue->AddMessage(1);
    EXPECT_EQ(fixture.PassesCausedBy([&] { fixture.Queue->GetMessage(taken); }), 1);
    EXPECT_EQ(fixture.PassesCausedBy([&] { fixture.Manager.WakeUpManagerEH(); }), 1);
}

TEST(ManagerWakeup, ManyEventsWhileAsleepCauseOnePass)
{
    SleepingFixture fixture;
    fixture.Manager.WakeUpManagerOnMessagePost(fixture.Message);
    fixture.Manager.WakeUpManagerOnEnqueue(fixture.Queue);
    EXPECT_EQ(fixture.PassesCausedBy(
                  [&]
                  {
                      fixture.Message->PostMessage();
                      fixture.Message->PostMessage();
                      fixture.Queue->AddMessage(1);
                      fixture.Manager.WakeUpManagerEH();
                  }),
              1);
}

TEST(ManagerWakeup, EventsDuringTheUnitOfWorkCauseExactlyOneMorePass)
{
    SleepingFixture fixture;
    fixture.Manager.WakeUpManagerOnMessagePost(fixture.Message);
    const auto poster = std::make_shared<NumberMessage>();
    fixture.Workspace.AddPublishSubscribeMessage("Message", poster);
    bool first = true;
    fixture.Manager.OnWork = [&]
    {
        for (int i = 0; first && i < 5; ++i)
        {
            poster->PostMessage();
            fixture.Queue->AddMessage(i);
            fixture.Manager.WakeUpManagerEH();
        }
        first = false;
    };
    EXPECT_EQ(fixture.PassesCausedBy([&] { fixture.Manager.WakeUpManagerEH(); }), 2);
}

TEST(ManagerWakeup, EventsDuringTheUnitOfWorkOfAThreadCauseExactlyOneMorePass)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Manager", workspace);
    manager.SetWakeupTimeDelaySec(1e6);
    const auto message = std::make_shared<NumberMessage>();
    manager.AddPublishSubscribeMessage("Message", message);
    manager.WakeUpManagerOnMessagePost(message);
    std::atomic<bool> inSecondPass{false};
    std::atomic<bool> posted{false};
    manager.OnWork = [&]
    {
        if (manager.Passes == 2)
        {
            inSecondPass = true;
            Eventually([&] { return posted.load(); });
        }
    };
    manager.Run();
    ASSERT_TRUE(Eventually([&] { return manager.Passes == 1; }));
    manager.WakeUpManagerEH();
    ASSERT_TRUE(Eventually([&] { return inSecondPass.load(); }));
    NumberMessage poster;
    poster.SetGlobalPublishSubscribeMessageRef(message->GetGlobalPublishSubscribeMessageRef());
    for (int i = 0; i < 10; ++i)
    {
        poster.PostMessage();
    }
    posted = true;
    ASSERT_TRUE(Eventually([&] { return manager.Passes == 3; }));
    // Another pass, if one was still to come, would run before this one.
    manager.WakeUpManagerEH();
    ASSERT_TRUE(Eventually([&] { return manager.Passes == 4; }));
    manager.ShutdownManager();
    manager.Join();
    EXPECT_EQ(manager.Passes, 4);
}

TEST(ManagerWakeup, ByAMessageThatIsNotRegisteredIsRefused)
{
    SleepingFixture fixture;
    EXPECT_THROW(fixture.Manager.WakeUpManagerOnMessagePost(std::make_shared<NumberMessage>()),
                 GlobalPublishSubscribeException);
    EXPECT_THROW(fixture.Manager.WakeUpManagerOnMessagePost(std::shared_ptr<NumberMessage>()),
                 std::invalid_argument);
}

TEST(ManagerWakeup, RegisteredTwiceCountsOnce)
{
    SleepingFixture fixture;
    fixture.Manager.WakeUpManagerOnEnqueue(fixture.Queue);
    fixture.Manager.WakeUpManagerOnEnqueue(fixture.Queue);
    fixture.Queue->AddMessage(1);
    fixture.Manager.GetControlThisManagerMessage()->PublishMgrStatsTime_Sec = 0.001;
    fixture.RunFor(1s);
    EXPECT_EQ(fixture.StatusOf("Manager")->ManagerStats.NumberOfWakeUpCallsWhileAsleep, 1);
}

TEST(ManagerWakeup, EndsWithTheManager)
{
    RabitWorkspace workspace;
    const auto message = std::make_shared<NumberMessage>();
    const auto queue = std::make_shared<RabitMessageQueue<int>>(10, "Queue");
    workspace.AddPublishSubscribeMessage("Message", message);
    std::weak_ptr<int> alive;
    {
        ScriptedManager manager("Manager", workspace);
        const auto own = std::make_shared<NumberMessage>();
        manager.AddPublishSubscribeMessage("Message", own);
        manager.WakeUpManagerOnMessagePost(own);
        manager.WakeUpManagerOnEnqueue(queue);
        manager.WakeUpManagerOnDequeue(queue);
        // A handler of the program's own, that calls the manager.
        const auto captured = std::make_shared<int>(0);
        alive = captured;
        own->Register_SomethingPublished([captured, &manager] { manager.WakeUpManagerEH(); });
    }
    EXPECT_TRUE(alive.expired());
    message->PostMessage();
    queue->AddMessage(1);
    int taken = 0;
    queue->GetMessage(taken);
}

TEST(ManagerWakeup, OfAManagerThatIsJustDestroyedIsSafe)
{
    RabitWorkspace workspace;
    const auto message = std::make_shared<NumberMessage>();
    workspace.AddPublishSubscribeMessage("Message", message);
    std::atomic<bool> stop{false};
    std::thread posting(
        [&]
        {
            while (!stop)
            {
                message->PostMessage();
            }
        });
    const auto wakeUps = std::make_shared<std::atomic<int>>(0);
    bool eachWasWoken = true;
    for (int i = 0; i < 200; ++i)
    {
        ScriptedManager manager("Manager", workspace);
        const auto own = std::make_shared<NumberMessage>();
        manager.AddPublishSubscribeMessage("Message", own);
        manager.WakeUpManagerOnMessagePost(own);
        const int before = *wakeUps;
        own->Register_SomethingPublished(
            [wakeUps, wakeUp = manager.WakeUpHandler()]
            {
                ++*wakeUps;
                wakeUp();
            });
        // Destroyed while the other thread posts.
        eachWasWoken = Eventually([&] { return *wakeUps > before; }) && eachWasWoken;
    }
    stop = true;
    posting.join();
    EXPECT_TRUE(eachWasWoken);
    const int before = *wakeUps;
    message->PostMessage();
    EXPECT_EQ(*wakeUps, before);
    EXPECT_EQ(wakeUps.use_count(), 1) << "a handler outlived its manager";
}

}  // namespace
