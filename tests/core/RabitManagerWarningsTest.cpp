#include "CapturedLog.h"
#include "SteppedFixture.h"
#include "TestMessages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

struct WarningsFixture : SteppedFixture
{
    CapturedLog Log;
    ScriptedManager &Manager = Add("Manager");
    std::shared_ptr<NumberMessage> Message = std::make_shared<NumberMessage>();
    std::shared_ptr<RabitMessageQueue<std::string>> Lines =
        std::make_shared<RabitMessageQueue<std::string>>(10, "Lines");

    WarningsFixture() { Manager.AddPublishSubscribeMessage("Number", Message); }
    std::vector<std::string> Run(std::chrono::nanoseconds duration = 5s)
    {
        Reactor.Start();
        RunFor(duration);
        return Log.Lines();
    }
};

bool Says(const std::vector<std::string> &lines, const std::string &words)
{
    return lines.size() == 1 && lines[0].find(words) != std::string::npos;
}

TEST(ManagerWarnings, AWakeupThatThePeriodHoldsBackIsNamedOnce)
{
    WarningsFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Manager.WakeUpManagerOnMessagePost(fixture.Message);
    const std::vector<std::string> lines = fixture.Run();
    EXPECT_TRUE(
        Says(lines, "manager \"Manager\" is not woken between turns: its wake-up on message \"Number\""));
    EXPECT_TRUE(Says(lines, "SetWakeupBetweenTurns(true)"));
}

TEST(ManagerWarnings, AWakeupThatThePeriodHoldsBackDoesNotWakeTheManager)
{
    WarningsFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Manager.WakeUpManagerOnMessagePost(fixture.Message);
    fixture.Run(500ms);
    fixture.Message->PostMessage();
    fixture.RunFor(400ms);
    EXPECT_EQ(fixture.Manager.Passes, 1);
}

TEST(ManagerWarnings, AWakeupOnAQueueThatThePeriodHoldsBackIsNamed)
{
    WarningsFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Manager.AddManagerMessageQueue("Lines", fixture.Lines);
    fixture.Manager.WakeUpManagerOnEnqueue(fixture.Lines);
    EXPECT_TRUE(Says(fixture.Run(), "its wake-up on queue \"Lines\""));
}

TEST(ManagerWarnings, AWakeupOnAReceiptThatThePeriodHoldsBackIsNamed)
{
    WarningsFixture fixture;
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Manager.WakeUpManagerOnOutcome(receipt);
    EXPECT_TRUE(Says(fixture.Run(), "its wake-up on a receipt"));
}

TEST(ManagerWarnings, AWakeupThatIsRegisteredInTheUnitOfWorkIsSeen)
{
    WarningsFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    fixture.Manager.OnWork = [&]
    {
        if (fixture.Manager.Passes == 3)
        {
            fixture.Manager.WakeUpManagerOnMessagePost(fixture.Message);
        }
    };
    EXPECT_TRUE(Says(fixture.Run(), "message \"Number\""));
}

TEST(ManagerWarnings, TheFirstReceiptIsSeenThoughItComesLate)
{
    WarningsFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    fixture.Manager.OnWork = [&]
    {
        if (fixture.Manager.Passes == 3)
        {
            fixture.Manager.WakeUpManagerOnOutcome(receipt);
        }
    };
    EXPECT_TRUE(Says(fixture.Run(), "its wake-up on a receipt"));
}

TEST(ManagerWarnings, NothingIsSaidOfAPeriodIfTheProgramChoseForTheTimeBetweenTurns)
{
    for (const bool choice : {true, false})
    {
        WarningsFixture fixture;
        fixture.Manager.SetPeriodSec(1.0);
        fixture.Manager.WakeUpManagerOnMessagePost(fixture.Message);
        fixture.Manager.SetWakeupBetweenTurns(choice);
        EXPECT_TRUE(fixture.Run().empty());
    }
}

TEST(ManagerWarnings, NothingIsSaidOfAPeriodWithoutWakeups)
{
    WarningsFixture fixture;
    fixture.Manager.SetPeriodSec(1.0);
    EXPECT_TRUE(fixture.Run().empty());
}

TEST(ManagerWarnings, AQueueThatNothingWakesTheManagerForIsNamedOnce)
{
    WarningsFixture fixture;
    fixture.Manager.AddManagerMessageQueue("Lines", fixture.Lines);
    const std::vector<std::string> lines = fixture.Run();
    EXPECT_TRUE(Says(
        lines, "manager \"Manager\" is not woken by its queue \"Lines\": messages wait there for up to 1 s"));
    EXPECT_TRUE(Says(lines, "WakeUpManagerOnEnqueue"));
}

TEST(ManagerWarnings, NothingIsSaidOfAQueueWithAWakeupOrAHandler)
{
    WarningsFixture woken;
    woken.Manager.AddManagerMessageQueue("Lines", woken.Lines);
    woken.Manager.WakeUpManagerOnEnqueue(woken.Lines);
    EXPECT_TRUE(woken.Run().empty());

    WarningsFixture handled;
    handled.Manager.AddManagerMessageQueue("Lines", handled.Lines);
    handled.Lines->Register_SomethingEnqueued([&] { handled.Manager.WakeUpManagerEH(); });
    EXPECT_TRUE(handled.Run().empty());
}

TEST(ManagerWarnings, NothingIsSaidOfAQueueIfTheProgramChoseDelayOrPeriod)
{
    WarningsFixture delayed;
    delayed.Manager.AddManagerMessageQueue("Lines", delayed.Lines);
    delayed.Manager.SetWakeupTimeDelaySec(1.0);
    EXPECT_TRUE(delayed.Run().empty());

    WarningsFixture periodic;
    periodic.Manager.AddManagerMessageQueue("Lines", periodic.Lines);
    periodic.Manager.SetPeriodSec(1.0);
    EXPECT_TRUE(periodic.Run().empty());
}

TEST(ManagerWarnings, NothingIsSaidOfTheManagersOwnQueueThatTheProgramSwitchedOff)
{
    WarningsFixture fixture;
    fixture.Manager.SetWakeupManagerUponMessagePostedToManagersMessageQueue(false);
    EXPECT_TRUE(fixture.Run().empty());
}

TEST(ManagerWarnings, AUnitOfWorkOfASecondIsNamedOnce)
{
    WarningsFixture fixture;
    fixture.Manager.OnWork = [&] { fixture.Clock->Advance(1200ms); };
    EXPECT_TRUE(Says(fixture.Run(10s), "manager \"Manager\": a unit of work took 1.2 s"));
}

TEST(ManagerWarnings, NothingIsSaidOfAUnitOfWorkThatTakesItsTime)
{
    WarningsFixture shorter;
    shorter.Manager.OnWork = [&] { shorter.Clock->Advance(999ms); };
    EXPECT_TRUE(shorter.Run(10s).empty());

    WarningsFixture within;
    within.Manager.SetPeriodSec(60.0);
    within.Manager.OnWork = [&] { within.Clock->Advance(2s); };
    EXPECT_TRUE(within.Run(100s).empty());

    WarningsFixture blocking;
    blocking.Manager.SetWakeupTimeDelayMSec(0);
    blocking.Manager.OnWork = [&] { blocking.Clock->Advance(2s); };
    EXPECT_TRUE(blocking.Run(10s).empty());
}

}  // namespace
