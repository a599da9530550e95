#include "CapturedLog.h"
#include "SteppedFixture.h"

#include <rabit/RabitTimer.h>

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

TEST(RabitTimer, IsDueAtTheFirstCallAndThenOnceAPeriod)
{
    RabitTimer timer(100ms);
    EXPECT_EQ(timer.UntilDue(5s), 0ns);
    EXPECT_TRUE(timer.IsDue(1000ms));
    EXPECT_FALSE(timer.IsDue(1000ms));
    EXPECT_FALSE(timer.IsDue(1099ms));
    EXPECT_TRUE(timer.IsDue(1100ms));
    EXPECT_FALSE(timer.IsDue(1199ms));
}

TEST(RabitTimer, DoesNotAddUpLateness)
{
    RabitTimer timer(100ms);
    timer.IsDue(0ms);
    int turns = 0;
    // Looks 7 ms after each turn.
    for (auto now = 107ms; now < 10'000ms; now += 100ms)
    {
        turns += timer.IsDue(now) ? 1 : 0;
    }
    EXPECT_EQ(turns, 99);
    EXPECT_EQ(timer.UntilDue(9'990ms), 10ms);
}

TEST(RabitTimer, SkipsTurnsThatWereSleptThrough)
{
    RabitTimer timer(100ms);
    timer.IsDue(0ms);
    EXPECT_TRUE(timer.IsDue(1'050ms));
    EXPECT_FALSE(timer.IsDue(1'060ms));
    EXPECT_EQ(timer.UntilDue(1'060ms), 40ms);
    EXPECT_EQ(timer.UntilDue(1'100ms), 0ms);
    EXPECT_EQ(timer.UntilDue(1'120ms), 0ms);
}

TEST(RabitTimer, WithoutAPeriodIsAlwaysDue)
{
    RabitTimer timer(0ms);
    EXPECT_TRUE(timer.IsDue(1s));
    EXPECT_TRUE(timer.IsDue(1s));
    EXPECT_EQ(timer.UntilDue(1s), 0ns);
}

// After a long unit of work a turn has come already.
TEST(RabitTimer, AUnitOfWorkOfASecondIsWarnedOf)
{
    const CapturedLog log;
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Manager");
    RabitTimer timer(20ms);
    manager.OnWork = [&]
    {
        timer.IsDue(manager);
        fixture.Clock->Advance(1200ms);
        RabitTimer::SleepUntilDue(manager, {&timer});
    };
    fixture.Reactor.Start();
    fixture.RunFor(2s);
    ASSERT_EQ(log.Lines().size(), 1u);
    EXPECT_NE(log.Lines()[0].find("a unit of work took 1.2 s"), std::string::npos) << log.Lines()[0];
}

// A manager with two timers that is also woken every 7 ms.
TEST(RabitTimer, SeveralKeepTheirTurnsThoughTheManagerIsWokenInBetween)
{
    for (const bool woken : {false, true})
    {
        SteppedFixture fixture;
        ScriptedManager &manager = fixture.Add("Manager");
        RabitTimer quick(20ms);
        RabitTimer slow(50ms);
        std::vector<std::chrono::nanoseconds> quickTurns;
        std::vector<std::chrono::nanoseconds> slowTurns;
        manager.OnWork = [&]
        {
            const auto now = fixture.Clock->Monotonic();
            if (quick.IsDue(manager))
            {
                quickTurns.push_back(now);
            }
            if (slow.IsDue(manager))
            {
                slowTurns.push_back(now);
            }
            RabitTimer::SleepUntilDue(manager, {&quick, &slow});
        };
        fixture.Reactor.Start();
        for (auto passed = 0ms; passed < 98ms; passed += 7ms)
        {
            fixture.RunFor(7ms);
            if (woken)
            {
                manager.WakeUpManagerEH();
            }
        }
        EXPECT_EQ(quickTurns, (std::vector<std::chrono::nanoseconds>{0ms, 20ms, 40ms, 60ms, 80ms}));
        EXPECT_EQ(slowTurns, (std::vector<std::chrono::nanoseconds>{0ms, 50ms}));
        EXPECT_EQ(manager.Passes, woken ? 6 + 14 - 1 : 6) << "no pass but for turns and wake-ups";
    }
}

}  // namespace
