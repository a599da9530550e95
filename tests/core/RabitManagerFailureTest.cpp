#include "CapturedLog.h"
#include "SteppedFixture.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

TEST(ManagerFailure, OfTheUnitOfWorkIsReportedOnceAndClearedByTheNextGoodPass)
{
    const CapturedLog log;
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.GetControlThisManagerMessage()->PublishMgrStatsTime_Sec = 0.0;
    bool fail = true;
    manager.OnWork = [&]
    {
        if (fail)
        {
            throw std::runtime_error("no fix");
        }
    };
    fixture.Reactor.Start();
    const auto global = fixture.Workspace.FindGlobalMessage("Manager:ManagerStatusMessage");
    const std::uint64_t postsBefore = global->GetNumberOfPosts();
    fixture.RunFor(5s);
    EXPECT_EQ(manager.Passes, 6);
    EXPECT_EQ(global->GetNumberOfPosts(), postsBefore + 1);
    EXPECT_TRUE(fixture.StatusOf("Manager")->ErrorCondition);
    EXPECT_EQ(fixture.StatusOf("Manager")->ErrorCode, 1);
    EXPECT_EQ(fixture.StatusOf("Manager")->RunningState, ManagerStatusMessage::MgrState_Running);
    ASSERT_FALSE(log.Lines().empty());
    EXPECT_NE(log.Lines()[0].find("no fix"), std::string::npos);
    fail = false;
    fixture.RunFor(1s);
    EXPECT_FALSE(fixture.StatusOf("Manager")->ErrorCondition);
    EXPECT_EQ(fixture.StatusOf("Manager")->ErrorCode, 0);
}

TEST(ManagerFailure, OfAnyTypeIsContained)
{
    const CapturedLog log;
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.OnWork = [] { throw 42; };
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    EXPECT_EQ(manager.Passes, 2);
    EXPECT_TRUE(fixture.StatusOf("Manager")->ErrorCondition);
}

TEST(ManagerFailure, DoesNotSpinThoughTheManagerDoesNotSleepAndWakesItself)
{
    const CapturedLog log;
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelayMSec(0);
    manager.OnWork = [] { throw std::runtime_error("again"); };
    fixture.Reactor.Start();
    fixture.RunFor(10s);
    EXPECT_EQ(manager.Passes, 101);
    manager.OnWork = [&]
    {
        manager.WakeUpManagerEH();
        throw std::runtime_error("again");
    };
    manager.SetWakeupTimeDelayMSec(1000);
    manager.Passes = 0;
    fixture.RunFor(10s);
    EXPECT_LE(manager.Passes, 1001);
}

TEST(ManagerFailure, OnAThreadPausesThoughTheManagerDoesNotSleep)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    ScriptedManager manager("Manager", workspace);
    manager.SetWakeupTimeDelayMSec(0);
    const auto start = std::chrono::steady_clock::now();
    manager.OnWork = [&]
    {
        if (manager.Passes == 4)
        {
            manager.ShutdownManager();
        }
        throw std::runtime_error("again");
    };
    manager.Run();
    manager.Join();
    // A slow computer cannot make the pause too short.
    EXPECT_GE(std::chrono::steady_clock::now() - start, 300ms);
}

TEST(ManagerFailure, ThatGoesOnIsLoggedAtMostOnceASecond)
{
    const CapturedLog log;
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelayMSec(10);
    manager.OnWork = [] { throw std::runtime_error("again"); };
    fixture.Reactor.Start();
    fixture.RunFor(5s);
    EXPECT_EQ(manager.Passes, 501);
    EXPECT_EQ(log.Lines().size(), 6u);
    EXPECT_NE(log.Lines().back().find("99 times"), std::string::npos) << log.Lines().back();
}

TEST(ManagerFailure, OfStartupEndsTheManagerWithoutAUnitOfWorkAndStaysReported)
{
    const CapturedLog log;
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    ScriptedManager &healthy = fixture.Add("Healthy");
    manager.OnStartup = [] { throw std::runtime_error("no serial port"); };
    fixture.Reactor.Start();
    fixture.RunFor(3s);
    EXPECT_EQ(manager.Passes, 0);
    EXPECT_EQ(manager.Shutdowns, 1);
    EXPECT_EQ(healthy.Passes, 4);
    EXPECT_EQ(fixture.StatusOf("Manager")->ErrorCode, ManagerStatusMessage::Error_Startup);
    EXPECT_TRUE(fixture.StatusOf("Manager")->ErrorCondition);
    EXPECT_EQ(fixture.StatusOf("Manager")->RunningState, ManagerStatusMessage::MgrState_Shutdown);
    EXPECT_EQ(log.Lines().size(), 1u);
}

TEST(ManagerFailure, OfShutdownIsReported)
{
    const CapturedLog log;
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    fixture.Add("Other");
    manager.OnShutdown = [] { throw std::runtime_error("stuck"); };
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    manager.ShutdownManager();
    fixture.RunFor(1s);
    EXPECT_EQ(fixture.StatusOf("Manager")->ErrorCode, ManagerStatusMessage::Error_Shutdown);
    EXPECT_EQ(fixture.StatusOf("Manager")->RunningState, ManagerStatusMessage::MgrState_Shutdown);
    EXPECT_EQ(log.Lines().size(), 1u);
}

}  // namespace
