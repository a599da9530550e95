#include "CapturedLog.h"

#include <rabit/RabitEvent.h>

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;

TEST(RabitEvent, CallsItsHandlersInTheOrderOfConnection)
{
    RabitEvent event;
    std::string order;
    event.Connect([&] { order += "a"; });
    event.Connect([&] { order += "b"; });
    event.Fire();
    EXPECT_EQ(order, "ab");
}

TEST(RabitEvent, ADisconnectedHandlerIsNotCalledAndOthersAre)
{
    RabitEvent event;
    int first = 0;
    int second = 0;
    RabitConnection connection = event.Connect([&] { ++first; });
    event.Connect([&] { ++second; });
    EXPECT_TRUE(connection.IsConnected());
    connection.Disconnect();
    connection.Disconnect();
    event.Fire();
    EXPECT_FALSE(connection.IsConnected());
    EXPECT_EQ(first, 0);
    EXPECT_EQ(second, 1);
}

TEST(RabitEvent, AHandlerThatWasHandedOverIsDisconnectedFromTheOtherEvent)
{
    for (const bool ownEventIsGone : {false, true})
    {
        const int owner = 0;
        const auto used = std::make_shared<int>(0);
        auto event = std::make_unique<RabitEvent>();
        RabitEvent other;
        RabitConnection connection = event->Connect([used] { ++*used; }, &owner);
        event->HandOverAllOf(&owner, other);
        if (ownEventIsGone)
        {
            event.reset();
        }
        EXPECT_TRUE(connection.IsConnected());
        other.Fire();
        EXPECT_EQ(*used, 1);
        connection.Disconnect();
        EXPECT_FALSE(connection.IsConnected());
        other.Fire();
        EXPECT_EQ(*used, 1);
        EXPECT_EQ(used.use_count(), 1) << "the handler is destroyed";
    }
}

TEST(RabitEvent, AHandlerThatWasHandedOverIsGoneWithTheOtherEvent)
{
    const int owner = 0;
    RabitEvent event;
    auto other = std::make_unique<RabitEvent>();
    RabitConnection connection = event.Connect([] {}, &owner);
    event.HandOverAllOf(&owner, *other);
    other.reset();
    EXPECT_FALSE(connection.IsConnected());
    connection.Disconnect();
}

TEST(RabitEvent, AHandlerThatThrowsIsLoggedAndTheOthersStillRun)
{
    const CapturedLog log;
    RabitEvent event;
    bool called = false;
    event.Connect([] { throw std::runtime_error("broken handler"); });
    event.Connect([] { throw 5; });
    event.Connect([&] { called = true; });
    event.Fire();
    EXPECT_TRUE(called);
    ASSERT_EQ(log.Lines().size(), 2u);
    EXPECT_NE(log.Lines()[0].find("broken handler"), std::string::npos);
}

TEST(RabitEvent, AHandlerMayDisconnectItselfAndConnectOthers)
{
    RabitEvent event;
    int once = 0;
    int added = 0;
    RabitConnection connection;
    connection = event.Connect(
        [&]
        {
            ++once;
            connection.Disconnect();
            event.Connect([&] { ++added; });
        });
    event.Fire();
    event.Fire();
    EXPECT_EQ(once, 1);
    EXPECT_EQ(added, 1);
}

TEST(RabitEvent, WhatAHandlerOwnsIsReleasedWhenItIsDisconnected)
{
    RabitEvent event;
    auto owned = std::make_shared<int>(1);
    RabitConnection connection = event.Connect([owned] {});
    connection.Disconnect();
    EXPECT_EQ(owned.use_count(), 1);
}

TEST(RabitEvent, AScopedConnectionEndsWithItsScope)
{
    RabitEvent event;
    int calls = 0;
    {
        const RabitScopedConnection scoped = event.Connect([&] { ++calls; });
        event.Fire();
    }
    event.Fire();
    EXPECT_EQ(calls, 1);
}

TEST(RabitEvent, AConnectionMayOutliveItsEvent)
{
    RabitConnection connection;
    {
        RabitEvent event;
        connection = event.Connect([] {});
    }
    EXPECT_FALSE(connection.IsConnected());
    connection.Disconnect();
}

TEST(RabitEvent, AnEmptyHandlerIsRefused)
{
    RabitEvent event;
    EXPECT_THROW(event.Connect(RabitHandler()), std::invalid_argument);
}

TEST(RabitEvent, HandlersComeAndGoWhileOtherThreadsFire)
{
    RabitEvent event;
    std::atomic<bool> stop{false};
    std::atomic<int> calls{0};
    std::vector<std::thread> firing;
    for (int i = 0; i < 3; ++i)
    {
        firing.emplace_back(
            [&]
            {
                while (!stop)
                {
                    event.Fire();
                }
            });
    }
    for (int i = 0; i < 2000; ++i)
    {
        // The handler owns the objects that it uses, because it may still be running after its
        // disconnection.
        const RabitScopedConnection scoped =
            event.Connect([count = std::make_shared<int>(0), &calls] { ++calls; });
    }
    stop = true;
    for (std::thread &thread : firing)
    {
        thread.join();
    }
    const int before = calls;
    event.Fire();
    EXPECT_EQ(calls, before);
}

}  // namespace
