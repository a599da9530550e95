// Handlers that a thread passes to another one, because it must not be held up.
#include <rabit/RabitHandlerThread.h>

#include <rabit/PublishSubscribeMessage.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitMessage.h>
#include <rabit/RabitWorkspace.h>

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "CapturedLog.h"

namespace Rabit
{
namespace
{

using Thread = std::thread::id;

const std::string Subject = "uav1/Pose";
const std::shared_ptr<void> Nobody;

// A handler that has begun and waits until it may return.
struct Slow
{
    std::promise<void> Began;
    std::promise<void> May;
    int Calls = 0;

    void operator()()
    {
        if (++Calls == 1)
        {
            Began.set_value();
            May.get_future().wait();
        }
    }
};

void FireIn(RabitHandlerThread &handlers, const RabitEvent &event)
{
    const RabitHandlerThread::Scope scope(&handlers, Subject, Nobody);
    event.Fire();
}

TEST(RabitHandlerThreadTest, AHandlerRunsElsewhereAndAQuickOneHere)
{
    RabitEvent event;
    Thread usual;
    Thread quick;
    event.Connect([&] { usual = std::this_thread::get_id(); });
    event.Connect(RabitQuickHandler([&] { quick = std::this_thread::get_id(); }));
    RabitHandlerThread handlers;
    FireIn(handlers, event);
    EXPECT_EQ(quick, std::this_thread::get_id());
    handlers.Stop();
    EXPECT_NE(usual, Thread());
    EXPECT_NE(usual, std::this_thread::get_id());
}

TEST(RabitHandlerThreadTest, OutsideOfAScopeAndWithoutAThreadHandlersRunHere)
{
    RabitEvent event;
    std::vector<Thread> threads;
    event.Connect([&] { threads.push_back(std::this_thread::get_id()); });
    RabitHandlerThread handlers;
    event.Fire();
    {
        const RabitHandlerThread::Scope none(nullptr, Subject, Nobody);
        event.Fire();
    }
    EXPECT_EQ(threads, std::vector<Thread>(2, std::this_thread::get_id()));
}

TEST(RabitHandlerThreadTest, WhileAHandlerRunsTheFiringThreadGoesOn)
{
    RabitEvent event;
    const auto slow = std::make_shared<Slow>();
    event.Connect([slow] { (*slow)(); });
    RabitHandlerThread handlers;
    FireIn(handlers, event);
    slow->Began.get_future().wait();
    FireIn(handlers, event);
    FireIn(handlers, event);
    slow->May.set_value();
    handlers.Stop();
    EXPECT_EQ(slow->Calls, 2) << "one call stands for the two events that came during the first";
}

TEST(RabitHandlerThreadTest, ACallBeginsAfterTheLastPostThatItStandsFor)
{
    RabitWorkspace workspace;
    const auto posted = std::make_shared<ManagerControlMessage>();
    ASSERT_TRUE(workspace.AddPublishSubscribeMessage("Pose", posted));
    const auto global = posted->GetGlobalPublishSubscribeMessageRef();
    const auto slow = std::make_shared<Slow>();
    std::vector<int> seen;
    global->ConnectSomethingPublished(
        [&]
        {
            (*slow)();
            seen.push_back(global->GetCopyOfMessage()->MessageType);
        });
    RabitHandlerThread handlers;
    for (int number = 1; number <= 10; ++number)
    {
        posted->MessageType = number;
        const RabitHandlerThread::Scope scope(&handlers, Subject, global);
        posted->PostMessage();
        if (number == 1)
        {
            slow->Began.get_future().wait();
        }
    }
    slow->May.set_value();
    handlers.Stop();
    EXPECT_EQ(seen, std::vector<int>(2, 10));
}

TEST(RabitHandlerThreadTest, StopWaitsForWhatWasHandedOverAndThenHandlersRunHere)
{
    RabitEvent first;
    RabitEvent second;
    const auto slow = std::make_shared<Slow>();
    std::vector<Thread> threads;
    first.Connect([slow] { (*slow)(); });
    second.Connect([&] { threads.push_back(std::this_thread::get_id()); });
    RabitHandlerThread handlers;
    FireIn(handlers, first);
    slow->Began.get_future().wait();
    FireIn(handlers, second);
    slow->May.set_value();
    handlers.Stop();
    ASSERT_EQ(threads.size(), 1U);
    FireIn(handlers, second);
    ASSERT_EQ(threads.size(), 2U);
    EXPECT_EQ(threads.back(), std::this_thread::get_id());
}

TEST(RabitHandlerThreadTest, AHandlerThatWasDisconnectedMeanwhileIsNotCalled)
{
    RabitEvent event;
    RabitEvent other;
    const auto slow = std::make_shared<Slow>();
    event.Connect([slow] { (*slow)(); });
    int calls = 0;
    RabitConnection connection = other.Connect([&] { ++calls; });
    RabitHandlerThread handlers;
    FireIn(handlers, event);
    slow->Began.get_future().wait();
    FireIn(handlers, other);
    connection.Disconnect();
    slow->May.set_value();
    handlers.Stop();
    EXPECT_EQ(calls, 0);
}

TEST(RabitHandlerThreadTest, WhatOwnsTheEventIsKeptUntilItsHandlersHaveReturned)
{
    RabitHandlerThread handlers;
    const auto slow = std::make_shared<Slow>();
    auto owner = std::make_shared<RabitEvent>();
    const std::weak_ptr<RabitEvent> watched = owner;
    bool lived = false;
    owner->Connect(
        [&, slow]
        {
            (*slow)();
            lived = !watched.expired();
        });
    {
        const RabitHandlerThread::Scope scope(&handlers, Subject, owner);
        owner->Fire();
    }
    slow->Began.get_future().wait();
    owner.reset();
    slow->May.set_value();
    handlers.Stop();
    EXPECT_TRUE(lived);
    EXPECT_TRUE(watched.expired());
}

TEST(RabitHandlerThreadTest, TheWatchSeesEachCallAlsoOfOneThatThrows)
{
    struct Notes final : RabitHandlerThread::Watch
    {
        void Begins(const std::string &subject) override { Lines.push_back("begins " + subject); }
        void Returned() override { Lines.emplace_back("returned"); }
        std::vector<std::string> Lines;
    };
    const RabitTest::CapturedLog log;
    Notes notes;
    RabitEvent event;
    event.Connect([] { throw std::runtime_error("no map"); });
    RabitHandlerThread handlers(&notes);
    FireIn(handlers, event);
    handlers.Stop();
    EXPECT_EQ(notes.Lines, (std::vector<std::string>{"begins uav1/Pose", "returned"}));
    EXPECT_EQ(log.Lines().size(), 1U);
}

TEST(RabitHandlerThreadTest, AManagersWakeUpIsQuick)
{
    class Idle final : public RabitManager
    {
    public:
        explicit Idle(RabitWorkspace &workspace) : RabitManager("Idle", workspace) {}
        void ExecuteUnitOfWork() override {}
    };
    RabitWorkspace workspace;
    const Idle manager(workspace);
    EXPECT_NE(manager.WakeUpHandler().target<RabitQuickHandler>(), nullptr);
}

TEST(RabitHandlerThreadTest, AnEmptyQuickHandlerIsRefused)
{
    EXPECT_THROW(RabitQuickHandler{nullptr}, std::invalid_argument);
}

}  // namespace
}  // namespace Rabit
