#include "SteppedFixture.h"
#include "TestMessages.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

// Returns the events, with their times, of two managers with different delays that send to each other.
std::string HistoryOfOneRun()
{
    SteppedFixture fixture;
    std::string history;
    const auto note = [&](const char *what)
    { history += what + std::to_string(fixture.Clock->Monotonic() / 1ms) + " "; };
    ScriptedManager &fast = fixture.Add("Fast");
    ScriptedManager &slow = fixture.Add("Slow");
    const auto sent = std::make_shared<NumberMessage>();
    const auto received = std::make_shared<NumberMessage>();
    fast.AddPublishSubscribeMessage("Number", sent);
    slow.AddPublishSubscribeMessage("Number", received);
    slow.WakeUpManagerOnMessagePost(received);
    fast.SetWakeupTimeDelayMSec(300);
    slow.SetWakeupTimeDelayMSec(1000);
    fast.OnWork = [&]
    {
        note("f");
        if (++sent->Number % 2 == 0)
        {
            sent->PostMessage();
        }
    };
    slow.OnWork = [&] { note(received->FetchMessage() ? "S" : "s"); };
    fixture.Reactor.Start();
    fixture.RunFor(2s);
    return history;
}

TEST(SteppedReactor, RunsInAFixedOrderAtTheRightTimes)
{
    EXPECT_EQ(HistoryOfOneRun(), "f0 S0 f300 S300 f600 f900 S900 f1200 f1500 S1500 f1800 ");
}

TEST(SteppedReactor, RepeatsItself)
{
    EXPECT_EQ(HistoryOfOneRun(), HistoryOfOneRun());
}

// A week in which one manager posts once a second. Every tenth time it sends to another manager, which
// wakes on that.
struct Week
{
    std::uint64_t Passes = 0;
    std::uint64_t Digest = 0;  // of who ran when and saw what, in this order

    Week()
    {
        SteppedFixture fixture;
        const auto note = [&](int who, int seen)
        {
            ++Passes;
            for (const std::int64_t value :
                 {fixture.Clock->Monotonic() / 1ns, std::int64_t{who * 1000003 + seen}})
            {
                Digest = Digest * 6364136223846793005U + static_cast<std::uint64_t>(value);
            }
        };
        ScriptedManager &sensor = fixture.Add("Sensor");
        ScriptedManager &logger = fixture.Add("Logger");
        const auto sent = std::make_shared<NumberMessage>();
        const auto received = std::make_shared<NumberMessage>();
        sensor.AddPublishSubscribeMessage("Number", sent);
        logger.AddPublishSubscribeMessage("Number", received);
        logger.SetWakeupTimeDelaySec(3600);
        sensor.OnWork = [&]
        {
            ++sent->Number;
            sent->PostMessage();
            if (sent->Number % 10 == 0)
            {
                sensor.AddMessageToQueue("Logger", std::shared_ptr<RabitMessage>(sent->Clone()));
            }
            note(1, sent->Number);
        };
        logger.OnWork = [&]
        {
            std::shared_ptr<RabitMessage> message;
            while (logger.GetManagerMessageQueue()->GetMessage(message))
            {
            }
            received->FetchMessage();
            note(2, received->Number);
        };
        fixture.Reactor.Start();
        fixture.RunFor(7 * 24h);
    }
};

TEST(SteppedReactor, RunsAWeekTwiceWithTheSameResult)
{
    const Week first;
    const Week second;
    EXPECT_EQ(first.Digest, second.Digest);
    // The sensor has a pass for each second and one at the start. The logger has a tenth of the former, and
    // its first.
    EXPECT_EQ(first.Passes, 604801u + 60480u + 1u);
}

TEST(SteppedReactor, SaysWhenTheNextPassIsDue)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    EXPECT_FALSE(fixture.Reactor.NextDue().has_value());
    fixture.Reactor.Start();
    EXPECT_EQ(fixture.Reactor.NextDue(), 0s);
    EXPECT_EQ(fixture.Reactor.RunDue(), 1);
    EXPECT_EQ(fixture.Reactor.RunDue(), 0);
    EXPECT_EQ(fixture.Reactor.NextDue(), 1s);
    fixture.Clock->AdvanceTo(500ms);
    manager.WakeUpManagerEH();
    EXPECT_EQ(fixture.Reactor.NextDue(), 500ms);
    EXPECT_EQ(fixture.Reactor.RunDue(), 1);
    EXPECT_EQ(fixture.Reactor.NextDue(), 1500ms);
}

TEST(SteppedReactor, LetsTimePassForAManagerThatDoesNotSleep)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelayMSec(0);
    fixture.Reactor.Start();
    fixture.RunFor(10ms);
    EXPECT_EQ(manager.Passes, 11);
}

TEST(SteppedReactor, StopsManagersThatWakeEachOtherForEver)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.OnWork = [&] { manager.WakeUpManagerEH(); };
    fixture.Reactor.Start();
    EXPECT_THROW(fixture.Reactor.RunDue(), std::runtime_error);
}

TEST(SteppedReactor, StampsPostsWithItsClock)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    const auto message = std::make_shared<NumberMessage>();
    manager.AddPublishSubscribeMessage("Number", message);
    manager.OnWork = [&] { message->PostMessage(); };
    fixture.Reactor.Start();
    fixture.RunFor(3s);
    EXPECT_EQ(message->GetTimeStamp(), 1003.0);
}

TEST(SteppedReactor, EndsWhenItsManagersDoAndMayStartAgain)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    for (int run = 1; run <= 2; ++run)
    {
        fixture.Reactor.Start();
        fixture.RunFor(1s);
        EXPECT_TRUE(fixture.Reactor.IsRunning());
        EXPECT_NE(fixture.Workspace.FindQueue("Manager"), nullptr);
        manager.ShutdownAllManagers(true);
        fixture.RunFor(0s);
        EXPECT_FALSE(fixture.Reactor.IsRunning());
        EXPECT_EQ(fixture.Workspace.FindQueue("Manager"), nullptr);
        EXPECT_EQ(manager.Shutdowns, run);
    }
}

TEST(SteppedReactor, StartsManagersThatAreAddedLater)
{
    SteppedFixture fixture;
    ScriptedManager &first = fixture.Add("First");
    ScriptedManager *second = nullptr;
    first.OnWork = [&]
    {
        if (second == nullptr)
        {
            second = &fixture.Add("Second");
        }
    };
    fixture.Reactor.Start();
    fixture.RunFor(2s);
    ASSERT_NE(second, nullptr);
    EXPECT_EQ(second->Startups, 1);
    EXPECT_EQ(second->Passes, 3);
}

TEST(SteppedReactor, StopShutsEverybodyDownOnce)
{
    SteppedFixture fixture;
    ScriptedManager &first = fixture.Add("First");
    ScriptedManager &second = fixture.Add("Second");
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    first.ShutdownManager();
    fixture.RunFor(0s);
    fixture.Reactor.Stop();
    EXPECT_EQ(first.Shutdowns, 1);
    EXPECT_EQ(second.Shutdowns, 1);
}

TEST(SteppedReactor, RefusesAClockThatIsNotTheWorkspaces)
{
    SteppedFixture fixture;
    ManualClock other;
    EXPECT_THROW(fixture.Reactor.RunFor(other, 1s), std::invalid_argument);
}

}  // namespace
