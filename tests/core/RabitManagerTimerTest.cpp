#include "SteppedFixture.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

TEST(ManagerTimer, IsOneSecondUnlessSet)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    EXPECT_EQ(manager.GetWakeupTimeDelayMSec(), 1000);
    EXPECT_EQ(manager.GetWakeupTimeDelaySec(), 1.0);
    fixture.Reactor.Start();
    fixture.RunFor(10s);
    EXPECT_EQ(manager.Passes, 11);  // at 0, 1, ... 10 s
}

TEST(ManagerTimer, KeepsFractionsOfASecond)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelaySec(2.5);
    EXPECT_EQ(manager.GetWakeupTimeDelayMSec(), 2500);
    manager.SetWakeupTimeDelaySec(0.5);
    EXPECT_EQ(manager.GetWakeupTimeDelayMSec(), 500);
    fixture.Reactor.Start();
    fixture.RunFor(2s);
    EXPECT_EQ(manager.Passes, 5);
}

TEST(ManagerTimer, HasNoFloor)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelayMSec(3);
    EXPECT_EQ(manager.GetWakeupTimeDelayMSec(), 3);
    fixture.Reactor.Start();
    fixture.RunFor(30ms);
    EXPECT_EQ(manager.Passes, 11);
}

TEST(ManagerTimer, ZeroOrLessMeansDoNotSleep)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    for (const int delay : {0, -1, std::numeric_limits<int>::min()})
    {
        manager.SetWakeupTimeDelayMSec(1000);
        manager.SetWakeupTimeDelayMSec(delay);
        EXPECT_EQ(manager.GetWakeupTimeDelayMSec(), 0);
    }
    for (const double delay : {0.0, -3.0, -std::numeric_limits<double>::infinity()})
    {
        manager.SetWakeupTimeDelayMSec(1000);
        manager.SetWakeupTimeDelaySec(delay);
        EXPECT_EQ(manager.GetWakeupTimeDelayMSec(), 0);
    }
}

TEST(ManagerTimer, TakesVeryLongAndVeryShortDelays)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelaySec(3e6);
    EXPECT_EQ(manager.GetWakeupTimeDelaySec(), 3e6);
    EXPECT_EQ(manager.GetWakeupTimeDelayMSec(), std::numeric_limits<int>::max());
    manager.SetWakeupTimeDelaySec(std::numeric_limits<double>::infinity());
    EXPECT_EQ(manager.GetWakeupTimeDelaySec(), 1e9);
    manager.SetWakeupTimeDelaySec(1e-12);
    EXPECT_EQ(manager.GetWakeupTimeDelayMSec(), 1);
    EXPECT_THROW(manager.SetWakeupTimeDelaySec(std::numeric_limits<double>::quiet_NaN()),
                 std::invalid_argument);
    EXPECT_GT(manager.GetWakeupTimeDelaySec(), 0.0);
}

TEST(ManagerTimer, MayBeSetFromTheUnitOfWork)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    std::vector<std::chrono::nanoseconds> times;
    manager.OnWork = [&]
    {
        times.push_back(fixture.Clock->Monotonic());
        manager.SetWakeupTimeDelayMSec(manager.GetWakeupTimeDelayMSec() * 2);
    };
    fixture.Reactor.Start();
    fixture.RunFor(14s);
    EXPECT_EQ(times, (std::vector<std::chrono::nanoseconds>{0s, 2s, 6s, 14s}));
}

TEST(ManagerTimer, ASleepThatIsUnderWayFollowsANewDelay)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    manager.SetWakeupTimeDelaySec(3600.0);
    fixture.Reactor.Start();
    fixture.RunFor(10s);
    ASSERT_EQ(manager.Passes, 1);
    manager.SetWakeupTimeDelaySec(12.0);
    fixture.RunFor(1s);
    EXPECT_EQ(manager.Passes, 1);
    fixture.RunFor(1s);
    EXPECT_EQ(manager.Passes, 2);
}

TEST(ManagerTimer, ARealSleepThatIsUnderWayFollowsANewDelay)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Manager", workspace);
    manager.SetWakeupTimeDelaySec(1e6);
    manager.Run();
    ASSERT_TRUE(Eventually([&] { return manager.Passes == 1; }));
    manager.SetWakeupTimeDelayMSec(1);
    EXPECT_TRUE(Eventually([&] { return manager.Passes > 3; }));
    manager.ShutdownManager();
    manager.Join();
}

TEST(ManagerTimer, AManagerThatDoesNotSleepRunsAgainAndAgain)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Manager", workspace);
    manager.SetWakeupTimeDelayMSec(0);
    manager.OnWork = [&]
    {
        if (manager.Passes == 1000)
        {
            manager.ShutdownManager();
        }
    };
    manager.Run();
    manager.Join();
    EXPECT_EQ(manager.Passes, 1000);
}

}  // namespace
