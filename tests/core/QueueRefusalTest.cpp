#include "CapturedLog.h"
#include "SteppedFixture.h"
#include "TestMessages.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

using Lines = std::vector<std::string>;

struct RefusalFixture : SteppedFixture
{
    CapturedLog Log;
    ScriptedManager &Manager = Add("Manager");
    std::shared_ptr<RabitMessageQueue<int>> Small = std::make_shared<RabitMessageQueue<int>>(473, "any");

    RefusalFixture()
    {
        Manager.AddManagerMessageQueue("Small", Small);
        Manager.SetWakeupTimeDelaySec(1.0);
        Reactor.Start();
    }
    // Tries 3000 adds. Returns how many were accepted.
    int Add3000()
    {
        int taken = 0;
        for (int i = 0; i < 3000; ++i)
        {
            taken += Manager.GetWorkspace().AddMessageToQueue("Small", i) ? 1 : 0;
        }
        return taken;
    }
};

TEST(QueueRefusal, OfAFullQueueIsLoggedAtOnceByName)
{
    RefusalFixture fixture;
    EXPECT_EQ(fixture.Add3000(), 473);
    EXPECT_EQ(fixture.Log.Lines(), Lines{"queue \"Small\" is full: it refused a message, as 473 wait in it"});
}

TEST(QueueRefusal, OfTheSameQueueAreLoggedTogetherAMinuteLater)
{
    RefusalFixture fixture;
    fixture.Add3000();
    fixture.RunFor(59s);
    EXPECT_EQ(fixture.Log.Lines().size(), 1U);
    fixture.RunFor(1s);
    ASSERT_EQ(fixture.Log.Lines().size(), 2U);
    EXPECT_EQ(fixture.Log.Lines().back(), "queue \"Small\" was full and refused 2526 more messages");
    fixture.RunFor(10min);
    EXPECT_EQ(fixture.Log.Lines().size(), 2U);
}

TEST(QueueRefusal, IsLoggedNoMoreThanOnceAMinuteHoweverLongItLasts)
{
    RefusalFixture fixture;
    fixture.Add3000();
    for (int second = 0; second < 600; ++second)
    {
        for (int i = 0; i < 20; ++i)
        {
            EXPECT_FALSE(fixture.Workspace.AddMessageToQueue("Small", i));
        }
        fixture.RunFor(1s);
    }
    EXPECT_EQ(fixture.Log.Lines().size(), 11U);
}

TEST(QueueRefusal, IsLoggedForAnAdderWhoHasTheQueueItself)
{
    RefusalFixture fixture;
    while (fixture.Small->AddMessage(1))
    {
    }
    EXPECT_EQ(fixture.Log.Lines().size(), 1U);
}

TEST(QueueRefusal, IsLoggedForAQueueOfOneProducer)
{
    RefusalFixture fixture;
    const auto queue = std::make_shared<RabitNonBlockingSPSCQueue<int>>(2, "any");
    fixture.Manager.AddManagerMessageQueue("Spsc", queue);
    while (fixture.Workspace.AddMessageToQueue("Spsc", 1))
    {
    }
    EXPECT_EQ(fixture.Log.Lines(), Lines{"queue \"Spsc\" is full: it refused a message, as 2 wait in it"});
}

// A caller that adds without events tries again when there is room, as a gateway does.
TEST(QueueRefusal, OfAnAddWithoutEventsIsNotLogged)
{
    RefusalFixture fixture;
    while (fixture.Small->AddMessageNoEventTrigger(1))
    {
    }
    EXPECT_TRUE(fixture.Log.Lines().empty());
}

TEST(QueueRefusal, IsNotLoggedForAQueueWhoseNameIsGone)
{
    RefusalFixture fixture;
    fixture.Manager.AddManagerMessageQueue("Small", std::make_shared<RabitMessageQueue<int>>(1, "other"));
    while (fixture.Small->AddMessage(1))
    {
    }
    EXPECT_TRUE(fixture.Log.Lines().empty());
}

TEST(QueueRefusal, OfAnUnknownQueueIsCountedAndLoggedByName)
{
    RefusalFixture fixture;
    for (int i = 0; i < 13; ++i)
    {
        EXPECT_FALSE(fixture.Workspace.AddMessageToQueue("Smal", i));
        EXPECT_FALSE(
            fixture.Workspace.AddMessageToQueue("uav2/Autopilot", std::make_shared<NumberMessage>()));
    }
    EXPECT_EQ(fixture.Log.Lines(),
              (Lines{"there is no queue \"Smal\": a message for it was refused",
                     "there is no queue \"uav2/Autopilot\": a message for it was refused"}));
    const std::vector<UnknownQueueInfo> unknown = fixture.Workspace.GetListOfUnknownQueues();
    ASSERT_EQ(unknown.size(), 2U);
    EXPECT_EQ(unknown[0].Name, "Smal");
    EXPECT_EQ(unknown[0].RefusedAdds, 13U);
    fixture.RunFor(60s);
    ASSERT_EQ(fixture.Log.Lines().size(), 4U);
    EXPECT_EQ(fixture.Log.Lines()[2], "there is no queue \"Smal\": 12 more messages for it were refused");
}

TEST(QueueRefusal, OfEndlesslyManyNamesIsBounded)
{
    RefusalFixture fixture;
    for (int i = 0; i < 10000; ++i)
    {
        fixture.Workspace.AddMessageToQueue("Queue" + std::to_string(i), i);
    }
    EXPECT_LE(fixture.Workspace.GetListOfUnknownQueues().size(), 201U);
    EXPECT_LE(fixture.Log.Lines().size(), 201U);
}

TEST(QueueOutcomeText, IsAWord)
{
    std::ostringstream text;
    text << QueueOutcome::Pending << ", " << QueueOutcome::Delivered << ", " << QueueOutcome::Expired << ", "
         << QueueOutcome::InDoubt << ", " << QueueOutcome::Refused << "; " << QueueAddResult::Ok << ", "
         << QueueAddResult::Full << ", " << QueueAddResult::UnknownQueue << ", " << QueueAddResult::WrongType;
    EXPECT_EQ(text.str(),
              "pending, delivered, expired, in doubt, refused; ok, full, unknown queue, wrong type");
}

}  // namespace
