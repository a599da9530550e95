#include "SteppedFixture.h"
#include "TestMessages.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

using Times = std::vector<std::chrono::nanoseconds>;

// A manager that records the times of its units of work.
struct PeriodFixture : SteppedFixture
{
    ScriptedManager &Manager = Add("Manager");
    Times Passes;
    Times Turns;

    PeriodFixture()
    {
        Manager.OnWork = [this] { Note(); };
    }
    void Note()
    {
        Passes.push_back(Clock->Monotonic());
        if (Manager.IsTurn())
        {
            Turns.push_back(Clock->Monotonic());
        }
    }
    // Lets time pass while something wakes the manager every millisecond.
    void RunWoken(std::chrono::milliseconds duration)
    {
        for (auto passed = 0ms; passed < duration; passed += 1ms)
        {
            Manager.WakeUpManagerEH();
            RunFor(1ms);
        }
    }
};

TEST(ManagerPeriod, RunsOnceAPeriodHoweverOftenTheManagerIsWoken)
{
    PeriodFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Reactor.Start();
    fixture.RunWoken(9s);
    EXPECT_EQ(fixture.Passes, (Times{0s, 1s, 2s, 3s, 4s, 5s, 6s, 7s, 8s, 9s}));
}

// Each post of the sensor is answered at once, by a message in its queue.
TEST(ManagerPeriod, ASensorThatIsAnsweredPostsOnceAPeriod)
{
    SteppedFixture fixture;
    ScriptedManager &sensor = fixture.Add("Sensor");
    ScriptedManager &listener = fixture.Add("Listener");
    const auto sent = std::make_shared<NumberMessage>();
    const auto received = std::make_shared<NumberMessage>();
    sensor.AddPublishSubscribeMessage("Number", sent);
    listener.AddPublishSubscribeMessage("Number", received);
    listener.WakeUpManagerOnMessagePost(received);
    sensor.SetPeriodSec(1.0);
    int posts = 0;
    int answers = 0;
    sensor.OnWork = [&]
    {
        std::shared_ptr<RabitMessage> answer;
        while (sensor.GetManagerMessageQueue()->GetMessage(answer))
        {
            ++answers;
        }
        ++posts;
        sent->PostMessage();
    };
    listener.OnWork = [&]
    {
        if (received->FetchMessage())
        {
            listener.AddMessageToQueue("Sensor", std::shared_ptr<RabitMessage>(received->Clone()));
        }
    };
    fixture.Reactor.Start();
    fixture.RunFor(9s);
    EXPECT_EQ(posts, 10);
    EXPECT_EQ(answers, 9);
}

TEST(ManagerPeriod, DoesNotDrift)
{
    PeriodFixture fixture;
    fixture.Manager.SetPeriodSec(0.1);
    fixture.Manager.OnWork = [&]
    {
        fixture.Note();
        fixture.Clock->Advance(37ms);  // how long the unit of work takes
    };
    fixture.Reactor.Start();
    fixture.RunFor(100s);
    ASSERT_GE(fixture.Turns.size(), 1000U);
    for (std::size_t i = 0; i < fixture.Turns.size(); ++i)
    {
        ASSERT_EQ(fixture.Turns[i], 100ms * static_cast<int>(i));
    }
    EXPECT_EQ(fixture.Manager.GetNumberOfMissedTurns(), 0U);
}

TEST(ManagerPeriod, RunsOnceForAllTurnsThatALongUnitOfWorkTookAndCountsTheOthersAsMissed)
{
    PeriodFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Manager.OnWork = [&]
    {
        fixture.Note();
        if (fixture.Passes.size() == 2)
        {
            fixture.Clock->Advance(3500ms);  // past the turns at 2, 3 and 4 s
        }
    };
    fixture.Reactor.Start();
    fixture.RunFor(6s);
    EXPECT_EQ(fixture.Passes, (Times{0s, 1s, 4500ms, 5s, 6s}));
    EXPECT_EQ(fixture.Manager.GetNumberOfMissedTurns(), 2U);
}

TEST(ManagerPeriod, TellsInItsStatusHowManyTurnsWereMissedSinceTheReset)
{
    PeriodFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Manager.GetControlThisManagerMessage()->PublishMgrStatsTime_Sec = 0.001;
    fixture.Manager.OnWork = [&]
    {
        if (fixture.Manager.Passes == 1)
        {
            fixture.Clock->Advance(5500ms);
        }
    };
    fixture.Reactor.Start();
    fixture.RunFor(10s);
    const std::uint64_t missed = fixture.StatusOf("Manager")->ManagerStats.NumberOfMissedTurns;
    EXPECT_EQ(missed, fixture.Manager.GetNumberOfMissedTurns());
    EXPECT_EQ(missed, 4U);
    EXPECT_NE(fixture.StatusOf("Manager")->ToString().find("Missed turns: " + std::to_string(missed)),
              std::string::npos);
    fixture.Manager.GetControlThisManagerMessage()->ResetMgrStatsToggle = true;
    fixture.RunFor(2s);
    EXPECT_EQ(fixture.StatusOf("Manager")->ManagerStats.NumberOfMissedTurns, 0U);
}

TEST(ManagerPeriod, IsWokenBetweenTurnsIfItWantsAndKnowsWhichPassIsATurn)
{
    PeriodFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Manager.SetWakeupBetweenTurns(true);
    fixture.Reactor.Start();
    fixture.RunFor(400ms);
    fixture.Manager.WakeUpManagerEH();
    fixture.RunFor(2s);
    EXPECT_EQ(fixture.Passes, (Times{0s, 400ms, 1s, 2s}));
    EXPECT_EQ(fixture.Turns, (Times{0s, 1s, 2s}));
}

TEST(ManagerPeriod, EveryPassIsATurnWithoutAPeriod)
{
    PeriodFixture fixture;
    fixture.Reactor.Start();
    fixture.RunWoken(10ms);
    EXPECT_GE(fixture.Passes.size(), 10U);
    EXPECT_EQ(fixture.Turns, fixture.Passes);
}

TEST(ManagerPeriod, GivenToARunningManagerBeginsThen)
{
    PeriodFixture fixture;
    fixture.Manager.SetWakeupTimeDelaySec(3600.0);
    fixture.Reactor.Start();
    fixture.RunFor(10s);
    fixture.Manager.SetPeriodSec(4.0);  // which the manager, asleep since 0 s, has slept already
    fixture.RunFor(9s);
    EXPECT_EQ(fixture.Passes, (Times{0s, 10s, 14s, 18s}));
    EXPECT_EQ(fixture.Manager.GetNumberOfMissedTurns(), 0U);
}

TEST(ManagerPeriod, SetInTheUnitOfWorkAgainAndAgainStaysWhereItIs)
{
    PeriodFixture fixture;
    fixture.Manager.OnWork = [&]
    {
        fixture.Note();
        fixture.Clock->Advance(10ms);
        fixture.Manager.SetPeriodSec(1.0);
    };
    fixture.Reactor.Start();
    fixture.RunFor(3500ms);
    EXPECT_EQ(fixture.Passes, (Times{0s, 1010ms, 2010ms, 3010ms}));
}

TEST(ManagerPeriod, ZeroOrLessGivesTheDelayBack)
{
    PeriodFixture fixture;
    fixture.Manager.SetWakeupTimeDelaySec(2.0);
    for (const double none : {0.0, -1.0, -std::numeric_limits<double>::infinity()})
    {
        fixture.Manager.SetPeriodSec(5.0);
        fixture.Manager.SetPeriodSec(none);
        EXPECT_EQ(fixture.Manager.GetPeriodSec(), 0.0);
    }
    fixture.Reactor.Start();
    fixture.RunFor(4s);
    EXPECT_EQ(fixture.Passes, (Times{0s, 2s, 4s}));
}

TEST(ManagerPeriod, IsNotANumberThatIsNone)
{
    PeriodFixture fixture;
    fixture.Manager.SetPeriodSec(0.25);
    EXPECT_THROW(fixture.Manager.SetPeriodSec(std::numeric_limits<double>::quiet_NaN()),
                 std::invalid_argument);
    EXPECT_EQ(fixture.Manager.GetPeriodSec(), 0.25);
}

TEST(ManagerPeriod, AControlMessageIsObeyedBetweenTurnsWithoutAUnitOfWork)
{
    PeriodFixture fixture;
    fixture.Manager.SetPeriodSec(10.0);
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    fixture.Manager.WakeUpManagerEH();  // a signal that does not count comes first
    ManagerControlMessage control;
    fixture.Workspace.ForceFetchMessage("ManagerControlMessage", &control);
    control.ShutdownManager(true);
    fixture.Workspace.FindGlobalMessage("ManagerControlMessage")->PostMessage(&control);
    fixture.RunFor(1ms);
    EXPECT_EQ(fixture.Manager.Shutdowns, 1);
    EXPECT_EQ(fixture.Passes, Times{0s});
}

TEST(ManagerPeriod, GoesOnAfterAUnitOfWorkThatThrew)
{
    PeriodFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Manager.OnWork = [&]
    {
        fixture.Note();
        throw std::runtime_error("on purpose");
    };
    fixture.Reactor.Start();
    fixture.RunWoken(3s);
    EXPECT_EQ(fixture.Passes, (Times{0s, 1s, 2s, 3s}));
}

TEST(ManagerPeriod, BeginsAnewInAnotherRun)
{
    PeriodFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Reactor.Start();
    fixture.RunFor(1500ms);
    fixture.Reactor.Stop();
    fixture.Clock->Advance(1h);
    fixture.Passes.clear();
    const std::chrono::nanoseconds start = fixture.Clock->Monotonic();
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    EXPECT_EQ(fixture.Passes, (Times{start, start + 1s}));
    EXPECT_EQ(fixture.Manager.GetNumberOfMissedTurns(), 0U);
}

// A manager on a thread. The thread's speed decides nothing: however late a turn comes, each moment that
// lies a period after the last is a pass or is counted as missed.
TEST(ManagerPeriod, OnAThreadEachTurnIsAPassOrMissedWhoeverWakesTheManager)
{
    constexpr auto period = 5ms;
    RabitWorkspace workspace;
    ScriptedManager manager("Manager", workspace);
    manager.SetPeriodSec(0.005);
    std::vector<std::chrono::steady_clock::time_point> times;
    manager.OnWork = [&]
    {
        times.push_back(std::chrono::steady_clock::now());
        if (times.size() == 40)
        {
            manager.ShutdownManager();
        }
    };
    const auto begin = std::chrono::steady_clock::now();
    manager.Run();
    std::atomic<bool> done{false};
    std::thread waker(
        [&]
        {
            while (!done)
            {
                manager.WakeUpManagerEH();
                std::this_thread::yield();
            }
        });
    manager.Join();
    done = true;
    waker.join();
    ASSERT_EQ(times.size(), 40U);
    const auto turns = static_cast<std::int64_t>(39 + manager.GetNumberOfMissedTurns());
    // The last turn had come when its pass began, and the one after it had not yet when the last sleep ended.
    // The first turn comes after `begin`; its pass may run late.
    EXPECT_GE(times.back() - begin, period * (turns - 1));
}

TEST(ManagerPeriod, OnAThreadAControlMessageEndsASleepThatSignalsDoNotEnd)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Manager", workspace);
    manager.SetPeriodSec(1e6);
    manager.Run();
    ASSERT_TRUE(Eventually([&] { return manager.Passes == 1; }));
    manager.WakeUpManagerEH();
    ManagerControlMessage control;
    workspace.ForceFetchMessage("Manager:ManagerControlMessage", &control);
    control.ShutdownManager(true);
    workspace.FindGlobalMessage("Manager:ManagerControlMessage")->PostMessage(&control);
    manager.Join();
    EXPECT_EQ(manager.Passes, 1);
}

}  // namespace
