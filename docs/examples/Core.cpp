// Clocks, the log, control and status of managers, sleeping, and tracing.
#include <gtest/gtest.h>
#include <rabit/ManagerControlMessage.h>
#include <rabit/ManagerStats.h>
#include <rabit/ManagerStatusMessage.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitBoost.h>
#include <rabit/RabitClock.h>
#include <rabit/RabitLog.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitManagerTrace.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitPeriod.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitVersion.h>
#include <rabit/RabitWakeup.h>
#include <rabit/SystemTimeClock.h>
#include <rabit/UptimeClock.h>

#include <boost/signals2.hpp>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace
{

using namespace std::chrono_literals;

// [log]
TEST(CoreExample, LinesOfTheLogGoWhereTheProgramWants)
{
    std::vector<std::string> lines;
    Rabit::RabitLog::SetSink([&lines](Rabit::RabitLogLevel, const std::string &line)
                             { lines.push_back(line); });
    Rabit::RabitLog::Write(Rabit::RabitLogLevel::Warning, "battery is low");
    Rabit::RabitLog::SetSink({});  // stderr again
    EXPECT_EQ(lines, std::vector<std::string>{"battery is low"});
}
// [/log]

// [compatible]
// A handler made for Boost.Signals2. A source that includes what it uses may define RABIT_LEAN_HEADERS.
TEST(CoreExample, AHandlerOfBoostIsTakenAsAnyOther)
{
    int added = 0;
    const Rabit::RabitBoostSlot slot([&added] { ++added; });
    Rabit::RabitMessageQueue<int> queue(10, "Numbers");
    queue.Register_SomethingEnqueued(slot.slot_function());
    queue.AddMessage(7);
    EXPECT_EQ(added, 1);
}
// [/compatible]

// [clocks]
TEST(CoreExample, TimeComesFromTheClockOfTheWorkspace)
{
    const std::shared_ptr<Rabit::RabitClock> &clock = Rabit::RabitClock::System();
    const Rabit::PostTime now = clock->Now();
    EXPECT_GT(now.GpsTimeSeconds, 1.4e9);  // since 1980-01-06
    EXPECT_LE(now.Monotonic,
              Rabit::UptimeClock::now().time_since_epoch());  // counts a suspended computer, too

    Rabit::SystemTimeClock &calendar = *Rabit::SystemTimeClock::GetSystemTimeClock();
    EXPECT_EQ(calendar.GetUTCTimeStringFromGpsTimeStamp(18), "1980-01-06T00:00:00");
}
// [/clocks]

// [status]
class Idle : public Rabit::RabitManager
{
public:
    explicit Idle(Rabit::RabitWorkspace &workspace) : RabitManager("Idle", workspace) { SetPeriodSec(1.0); }
    void ExecuteUnitOfWork() final {}
};

TEST(CoreExample, EachManagerPostsItsStatusAndObeysControlMessages)
{
    const auto clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace workspace(clock);
    Rabit::RabitSteppedReactor reactor(workspace);
    reactor.AddManager(std::make_unique<Idle>(workspace));
    reactor.Start();
    reactor.RunFor(*clock, 11s);

    Rabit::ManagerStatusMessage status;
    ASSERT_TRUE(workspace.ForceFetchMessage("Idle:ManagerStatusMessage", &status));
    const Rabit::ManagerStats_t &stats = status.ManagerStats;
    EXPECT_GT(stats.TotalNumberOfExecuteCycles, 9);

    const auto control = std::make_shared<Rabit::ManagerControlMessage>();
    workspace.AddPublishSubscribeMessage("Idle:ManagerControlMessage", control);
    control->ShutdownManager(true);
    control->PostMessage();
    reactor.RunDue();
    EXPECT_FALSE(reactor.IsRunning());
}
// [/status]

// [period]
TEST(CoreExample, TurnsOfAPeriodDoNotDrift)
{
    Rabit::RabitPeriod period;
    period.Set(1s);
    period.Begin(0s);
    EXPECT_TRUE(period.Take(0s, 2500ms));  // late: the turn at 1 s is missed
    EXPECT_EQ(period.Next(0s), 3s);
    EXPECT_EQ(period.Missed(), 1u);
}
// [/period]

// [wakeup]
TEST(CoreExample, ASignalEndsASleep)
{
    Rabit::RabitWakeup wakeup;
    wakeup.SetDelay(1h);
    wakeup.Signal();
    wakeup.Sleep(0s);  // returns at once
    EXPECT_FALSE(wakeup.IsShutdownRequested());
}
// [/wakeup]

// [trace]
// Counts the steps of a manager and what it posts.
class Counts : public Rabit::RabitManagerTrace
{
public:
    void BeginStep(Step, bool) override { ++Steps; }
    void EndStep(bool) override {}
    void ReadMonotonic(std::chrono::nanoseconds &) override {}
    void ReadGpsTime(double &) override {}
    void Fetched(const Rabit::PublishSubscribeMessage &, const Rabit::RabitMessage &, std::uint64_t) override
    {
    }
    std::optional<Rabit::PostTime> Posting(const Rabit::PublishSubscribeMessage &) override { return {}; }
    void Posted(const Rabit::PublishSubscribeMessage &, const Rabit::RabitMessage &, std::uint64_t) override
    {
    }
    void Taken(const std::string &, const Rabit::RabitMessage &) override {}
    std::optional<bool> Adding(const std::string &, const Rabit::RabitMessage &) override { return {}; }
    void Added(bool) override {}
    void Listed(std::vector<Rabit::MessageInfo> &) override {}

    int Steps = 0;
};

TEST(CoreExample, ATraceSeesTheStepsOfAManager)
{
    const auto clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace workspace(clock);
    const auto counts = std::make_shared<Counts>();
    workspace.SetManagerTracing([counts](const std::string &) { return counts; });
    Rabit::RabitSteppedReactor reactor(workspace);
    reactor.AddManager(std::make_unique<Idle>(workspace));
    reactor.Start();
    reactor.RunFor(*clock, 2500ms);
    EXPECT_EQ(counts->Steps, 4);  // Startup and three units of work
}
// [/trace]

TEST(CoreExample, TheVersionIsKnownWhenAProgramIsCompiled)
{
    EXPECT_EQ(std::string(RABIT_VERSION_STRING).find("."), 1u);
}

}  // namespace
