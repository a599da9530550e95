// Posting, fetching, ages, handlers and names of messages.
#include <gtest/gtest.h>
#include <rabit/GlobalPublishSubscribeException.h>
#include <rabit/ManualClock.h>
#include <rabit/MessageNotRegisteredException.h>
#include <rabit/PublishSubscribeClass.h>
#include <rabit/PublishSubscribeMessage.h>
#include <rabit/RabitEvent.h>
#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitMessageLease.h>
#include <rabit/RabitWorkspace.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>

#include "uav.idl.h"

namespace
{

using namespace std::chrono_literals;

// [age]
TEST(MessagesExample, AFetchBringsTheNewestValueWithItsAge)
{
    const auto clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace workspace(clock);
    const auto mine = std::make_shared<Uav::Pose>();
    const auto theirs = std::make_shared<Uav::Pose>();
    workspace.AddPublishSubscribeMessage("Pose", mine);
    workspace.AddPublishSubscribeMessage("Pose", theirs);

    mine->altitude_m = 50;
    mine->PostMessage();
    clock->Advance(2s);

    EXPECT_TRUE(theirs->FetchMessage());
    EXPECT_EQ(theirs->altitude_m, 50);
    EXPECT_EQ(theirs->GetAgeSeconds(), 2);
    EXPECT_FALSE(theirs->FetchMessage());  // nothing new
}
// [/age]

// [errors]
TEST(MessagesExample, AMessageWithoutANameCannotBePosted)
{
    Uav::Pose pose;
    EXPECT_THROW(pose.PostMessage(), Rabit::GlobalPublishSubscribeException);

    Rabit::RabitWorkspace workspace;
    using Queue = std::shared_ptr<Rabit::RabitMessageQueue<std::string>>;
    EXPECT_THROW(workspace.GetManagerMessageQueue<Queue>("Lines"), Rabit::MessageNotRegisteredException);
}
// [/errors]

// [lease]
TEST(MessagesExample, ALeaseGivesANameForATime)
{
    Rabit::RabitWorkspace workspace;
    const auto pose = std::make_shared<Uav::Pose>();
    {
        const Rabit::RabitMessageLease lease(workspace, "uav7/Pose", pose);
        const std::shared_ptr<Rabit::PublishSubscribeMessage> &global = lease.Global();
        ASSERT_TRUE(global);
        EXPECT_TRUE(workspace.FindGlobalMessage("uav7/Pose"));
    }
    EXPECT_FALSE(workspace.FindGlobalMessage("uav7/Pose"));
}
// [/lease]

// [handlers]
TEST(MessagesExample, AHandlerIsCalledForEachPostUntilItsConnectionEnds)
{
    Rabit::RabitWorkspace workspace;
    const auto pose = std::make_shared<Uav::Pose>();
    workspace.AddPublishSubscribeMessage("Pose", pose);
    int posts = 0;
    Rabit::RabitConnection connection =
        workspace.FindGlobalMessage("Pose")->ConnectSomethingPublished([&posts] { ++posts; });
    pose->PostMessage();
    connection.Disconnect();
    pose->PostMessage();
    EXPECT_EQ(posts, 1);
}

TEST(MessagesExample, AnEventOfOnesOwnCallsItsHandlers)
{
    Rabit::RabitEvent landed;
    int heard = 0;
    {
        const Rabit::RabitScopedConnection connection = landed.Connect([&heard] { ++heard; });
        landed.Fire();
    }
    landed.Fire();
    EXPECT_EQ(heard, 1);
}

TEST(MessagesExample, AThreadThatMustNotBlockHandsItsHandlersOver)
{
    const auto event = std::make_shared<Rabit::RabitEvent>();
    std::atomic<int> slow{0};
    int quick = 0;
    event->Connect([&slow] { ++slow; });                              // on the thread for handlers
    event->Connect(Rabit::RabitQuickHandler([&quick] { ++quick; }));  // on this thread, at once
    Rabit::RabitHandlerThread handlers;
    {
        const std::string subject = "uav1/Pose";
        const Rabit::RabitHandlerThread::Scope scope(&handlers, subject, event);
        event->Fire();
    }
    EXPECT_EQ(quick, 1);
    handlers.Stop();  // waits for those that were handed over
    EXPECT_EQ(slow, 1);
}
// [/handlers]

}  // namespace
