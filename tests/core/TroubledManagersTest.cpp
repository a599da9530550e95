// Others learn of a manager that hangs or fails while it does.
#include "CapturedLog.h"
#include "SteppedFixture.h"

#include <rabit/RabitReactor.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

// A manager on a thread of its own, under a clock that only the test moves.
struct ThreadedFixture
{
    std::shared_ptr<ManualClock> Clock = std::make_shared<ManualClock>(1000.0, -50s);
    RabitWorkspace Workspace{Clock};
    ScriptedManager Manager{"Vision", Workspace};
    std::promise<void> Entered;
    std::promise<void> Release;

    ~ThreadedFixture()
    {
        Free();
        Manager.ShutdownManager();
        Manager.Join();
    }
    // Blocks the calling thread, which is the manager's, until the test releases it.
    void Block()
    {
        Entered.set_value();
        Release.get_future().wait();
    }
    void Free()
    {
        if (!std::exchange(_isFree, true))
        {
            Release.set_value();
        }
    }
    void RunUntilBlocked()
    {
        Manager.Run();
        Entered.get_future().wait();
    }
    std::vector<ManagerTrouble> Troubles() const { return Workspace.GetListOfTroubledManagers(); }

private:
    bool _isFree = false;
};

TEST(TroubledManagers, AUnitOfWorkThatHangsIsSeenByOthersUntilItEnds)
{
    ThreadedFixture fixture;
    fixture.Manager.OnWork = [&]
    {
        if (fixture.Manager.Passes == 1)
        {
            fixture.Block();
        }
    };
    fixture.RunUntilBlocked();
    fixture.Clock->Advance(1s - 1ns);
    EXPECT_TRUE(fixture.Troubles().empty());
    fixture.Clock->Advance(1ns);
    const std::vector<ManagerTrouble> troubles = fixture.Troubles();
    ASSERT_EQ(troubles.size(), 1u);
    EXPECT_EQ(troubles[0].Manager, "Vision");
    EXPECT_EQ(troubles[0].Step, "ExecuteUnitOfWork");
    EXPECT_EQ(troubles[0].HangsFor, 1s);
    EXPECT_EQ(troubles[0].Failure, "");
    fixture.Free();
    EXPECT_TRUE(Eventually([&] { return fixture.Troubles().empty(); }));
}

TEST(TroubledManagers, AUnitOfWorkMayTakeTwoPeriods)
{
    ThreadedFixture fixture;
    fixture.Manager.SetPeriodSec(3.0);
    fixture.Manager.OnWork = [&]
    {
        if (fixture.Manager.Passes == 1)
        {
            fixture.Block();
        }
    };
    fixture.RunUntilBlocked();
    fixture.Clock->Advance(6s - 1ns);
    EXPECT_TRUE(fixture.Troubles().empty());
    fixture.Clock->Advance(1ns);
    EXPECT_EQ(fixture.Troubles().size(), 1u);
}

TEST(TroubledManagers, AManagerThatNeverSleepsMayBlock)
{
    ThreadedFixture fixture;
    fixture.Manager.SetWakeupTimeDelayMSec(0);
    fixture.Manager.OnWork = [&]
    {
        if (fixture.Manager.Passes == 1)
        {
            fixture.Block();
            fixture.Manager.ShutdownManager();
        }
    };
    fixture.RunUntilBlocked();
    fixture.Clock->Advance(1h);
    EXPECT_TRUE(fixture.Troubles().empty());
}

TEST(TroubledManagers, AStartupThatHangsIsSeenAfterTenSeconds)
{
    ThreadedFixture fixture;
    fixture.Manager.OnStartup = [&] { fixture.Block(); };
    fixture.RunUntilBlocked();
    fixture.Clock->Advance(10s - 1ns);
    EXPECT_TRUE(fixture.Troubles().empty());
    fixture.Clock->Advance(1ns);
    ASSERT_EQ(fixture.Troubles().size(), 1u);
    EXPECT_EQ(fixture.Troubles()[0].Step, "Startup");
}

TEST(TroubledManagers, AManagerThatSleepsLongIsFine)
{
    SteppedFixture fixture;
    fixture.Add("Manager").SetWakeupTimeDelaySec(3600);
    fixture.Reactor.Start();
    fixture.RunFor(2h);
    EXPECT_TRUE(fixture.Workspace.GetListOfTroubledManagers().empty());
}

TEST(TroubledManagers, AManagerThatThrowsAtEachTurnIsSeenUntilATurnSucceeds)
{
    const CapturedLog log;
    SteppedFixture fixture;
    fixture.Add("Other");
    ScriptedManager &manager = fixture.Add("Manager");
    bool fails = true;
    manager.OnWork = [&]
    {
        if (fails)
        {
            throw std::runtime_error("no fix");
        }
    };
    fixture.Reactor.Start();
    fixture.RunFor(5s);
    const std::vector<ManagerTrouble> troubles = fixture.Workspace.GetListOfTroubledManagers();
    ASSERT_EQ(troubles.size(), 1u);
    EXPECT_EQ(troubles[0].Manager, "Manager");
    EXPECT_EQ(troubles[0].Step, "ExecuteUnitOfWork");
    EXPECT_EQ(troubles[0].HangsFor, 0s);
    EXPECT_EQ(troubles[0].Failure, "no fix");
    fails = false;
    fixture.RunFor(1s);
    EXPECT_TRUE(fixture.Workspace.GetListOfTroubledManagers().empty());
}

TEST(TroubledManagers, AManagerThatThrewAndHasNoFurtherTurnIsForgottenAfterTenSeconds)
{
    const CapturedLog log;
    SteppedFixture fixture;
    fixture.Add("Other");
    ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelaySec(3600);
    manager.OnWork = [] { throw std::runtime_error("a message that it cannot read"); };
    fixture.Reactor.Start();
    fixture.RunFor(5s);
    EXPECT_EQ(fixture.Workspace.GetListOfTroubledManagers().size(), 1u);
    fixture.RunFor(6s);
    EXPECT_TRUE(fixture.Workspace.GetListOfTroubledManagers().empty());
}

TEST(TroubledManagers, AManagerThatThrowsAtEachTurnOfALongPeriodIsSeenAllTheTime)
{
    const CapturedLog log;
    SteppedFixture fixture;
    fixture.Add("Other");
    ScriptedManager &manager = fixture.Add("Manager");
    manager.SetPeriodSec(20.0);
    manager.OnWork = [] { throw std::runtime_error("no fix"); };
    fixture.Reactor.Start();
    fixture.RunFor(59s);
    EXPECT_EQ(fixture.Workspace.GetListOfTroubledManagers().size(), 1u);
}

TEST(TroubledManagers, AManagerWhoseStartupThrewIsSeenUntilItRunsAgain)
{
    const CapturedLog log;
    SteppedFixture fixture;
    fixture.Add("Other");
    ScriptedManager &manager = fixture.Add("Manager");
    manager.OnStartup = [] { throw std::runtime_error("no camera"); };
    fixture.Reactor.Start();
    fixture.RunFor(5s);
    ASSERT_EQ(fixture.Workspace.GetListOfTroubledManagers().size(), 1u);
    EXPECT_EQ(fixture.Workspace.GetListOfTroubledManagers()[0].Step, "Startup");
    EXPECT_EQ(fixture.Workspace.GetListOfTroubledManagers()[0].Failure, "no camera");
    fixture.Reactor.Stop();
    manager.OnStartup = {};
    fixture.Reactor.Start();
    EXPECT_TRUE(fixture.Workspace.GetListOfTroubledManagers().empty());
}

TEST(TroubledManagers, AManagerThatHasEndedWellFailsNoMore)
{
    const CapturedLog log;
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.OnWork = [] { throw std::runtime_error("no fix"); };
    fixture.Reactor.Start();
    fixture.RunFor(2s);
    ASSERT_EQ(fixture.Workspace.GetListOfTroubledManagers().size(), 1u);
    fixture.Reactor.Stop();
    EXPECT_TRUE(fixture.Workspace.GetListOfTroubledManagers().empty());
}

TEST(TroubledManagers, AManagerThatIsGoneIsNoneOfThem)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    {
        RabitSteppedReactor reactor(workspace);
        auto manager = std::make_unique<ScriptedManager>("Manager", workspace);
        manager->OnStartup = [] { throw std::runtime_error("no camera"); };
        reactor.AddManager(std::move(manager));
        reactor.Start();
    }
    EXPECT_TRUE(workspace.GetListOfTroubledManagers().empty());
}

TEST(TroubledManagers, AReactorSaysWhichManagerHangsThoughNobodyToldItToShutDown)
{
    const CapturedLog log;
    const auto clock = std::make_shared<ManualClock>(1000.0);
    RabitWorkspace workspace(clock);
    RabitReactor reactor(workspace);
    reactor.SetPatience(1ms);
    auto added = std::make_unique<ScriptedManager>("Vision", workspace);
    ScriptedManager &manager = *added;
    reactor.AddManager(std::move(added));
    const auto isSaid = [&](const std::string &time)
    {
        const auto lines = log.Lines();
        return std::count(lines.begin(), lines.end(),
                          "manager \"Vision\" has been in ExecuteUnitOfWork for " + time +
                              ": its wake-ups, its queue and a shutdown wait for it") == 1;
    };
    manager.OnWork = [&]
    {
        clock->Advance(5s);
        EXPECT_TRUE(Eventually([&] { return isSaid("5.0 s"); }));
        clock->Advance(5s);
        EXPECT_TRUE(Eventually([&] { return isSaid("10.0 s"); }));
        manager.ShutdownManager();
    };
    reactor.Run();
}

}  // namespace
