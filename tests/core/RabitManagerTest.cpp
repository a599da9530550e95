#include "CapturedLog.h"
#include "SteppedFixture.h"
#include "TestMessages.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

TEST(RabitManager, RegistersItsQueueAndItsMessagesUnderItsName)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Pilot", workspace);
    EXPECT_EQ(workspace.GetManagerMessageQueue<std::shared_ptr<RabitManager::RabitQueue>>("Pilot"),
              manager.GetManagerMessageQueue());
    EXPECT_NE(workspace.FindGlobalMessage("ManagerControlMessage"), nullptr);
    EXPECT_NE(workspace.FindGlobalMessage("Pilot:ManagerControlMessage"), nullptr);
    ManagerStatusMessage status;
    EXPECT_TRUE(workspace.FetchMessage("Pilot:ManagerStatusMessage", &status));
    EXPECT_EQ(status.ManagerName, "Pilot");
    EXPECT_EQ(status.RunningState, ManagerStatusMessage::MgrState_Startup);
}

TEST(RabitManager, RefusesANameThatBelongsToAnotherMessage)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    workspace.AddPublishSubscribeMessage("Pilot:ManagerStatusMessage", std::make_shared<NumberMessage>());
    EXPECT_THROW(ScriptedManager("Pilot", workspace), std::invalid_argument);
}

TEST(RabitManager, ItsOwnQueueHasTheCapacityThatWasChosen)
{
    class Small : public RabitManager
    {
    public:
        explicit Small(RabitWorkspace &workspace) : RabitManager("Small", workspace, 3) {}
        void ExecuteUnitOfWork() final {}
    };
    RabitWorkspace workspace;
    Small manager(workspace);
    EXPECT_EQ(manager.GetManagerMessageQueue()->GetMaxNoMessagesAllowedInQueue(), 3);
    ScriptedManager usual("Usual", workspace);
    EXPECT_EQ(usual.GetManagerMessageQueue()->GetMaxNoMessagesAllowedInQueue(), 1000);
}

TEST(RabitManager, ItsStatusTellsOfItsQueues)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Pilot");
    manager.AddManagerMessageQueue("Orders", std::make_shared<RabitMessageQueue<int>>(1, "Orders"));
    fixture.Reactor.Start();
    for (int i = 0; i < 3; ++i)
    {
        fixture.Workspace.AddMessageToQueue("Orders", i);
        fixture.Workspace.AddMessageToQueue("Pilot", std::make_shared<NumberMessage>());
    }
    fixture.RunFor(11s);
    const auto status = fixture.StatusOf("Pilot");
    ASSERT_EQ(status->Queues.size(), 2U);
    EXPECT_EQ(status->Queues[0].Name, "Pilot");
    EXPECT_EQ(status->Queues[0].Capacity, 1000);
    EXPECT_EQ(status->Queues[0].FillLevel, 3);
    EXPECT_EQ(status->Queues[0].RefusedAdds, 0U);
    EXPECT_EQ(status->Queues[1].Name, "Orders");
    EXPECT_EQ(status->Queues[1].Capacity, 1);
    EXPECT_EQ(status->Queues[1].FillLevel, 1);
    EXPECT_EQ(status->Queues[1].RefusedAdds, 2U);
    EXPECT_NE(status->ToString().find("Queue Orders: 1 of 1, refused: 2"), std::string::npos);
}

TEST(RabitManager, ItsQueueNameEndsWithItButNotThatOfASuccessor)
{
    RabitWorkspace workspace;
    auto first = std::make_unique<ScriptedManager>("Pilot", workspace);
    auto second = std::make_unique<ScriptedManager>("Pilot", workspace);
    first.reset();
    EXPECT_NE(workspace.FindQueue("Pilot"), nullptr);
    second.reset();
    EXPECT_EQ(workspace.FindQueue("Pilot"), nullptr);
}

TEST(RabitManager, GoesThroughItsStatesInOrder)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Pilot");
    std::vector<int> states;
    const auto note = [&] { states.push_back(fixture.StatusOf("Pilot")->RunningState); };
    manager.OnStartup = note;
    manager.OnWork = note;
    manager.OnShutdown = note;
    fixture.Reactor.Start();
    fixture.RunFor(0s);
    manager.ShutdownManager();
    fixture.RunFor(0s);
    EXPECT_EQ(states, (std::vector<int>{ManagerStatusMessage::MgrState_Startup,
                                        ManagerStatusMessage::MgrState_Running,
                                        ManagerStatusMessage::MgrState_Shutdown}));
    EXPECT_EQ(manager.Shutdowns, 1);
}

TEST(RabitManager, ShutsDownByAPostOfItsControlMessage)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Pilot");
    ScriptedManager &other = fixture.Add("Other");
    const auto control = std::make_shared<ManagerControlMessage>();
    fixture.Workspace.AddPublishSubscribeMessage("Pilot:ManagerControlMessage", control);
    manager.SetWakeupTimeDelaySec(1e6);
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    control->ShutdownManager(true);
    control->PostMessage();
    fixture.RunFor(0s);
    EXPECT_EQ(manager.Shutdowns, 1);
    EXPECT_EQ(other.Shutdowns, 0);
}

TEST(RabitManager, ShutdownAllManagersReachesAllOfTheWorkspaceAndNoOthers)
{
    SteppedFixture fixture;
    SteppedFixture elsewhere;
    ScriptedManager &first = fixture.Add("First");
    ScriptedManager &second = fixture.Add("Second");
    ScriptedManager &stranger = elsewhere.Add("Stranger");
    second.SetWakeupTimeDelaySec(1e6);
    fixture.Reactor.Start();
    elsewhere.Reactor.Start();
    fixture.RunFor(1s);
    elsewhere.RunFor(1s);
    first.ShutdownAllManagers(true);
    EXPECT_TRUE(first.GetControlAllManagersMessage()->GetShutdownManager());
    fixture.RunFor(0s);
    elsewhere.RunFor(0s);
    EXPECT_EQ(first.Shutdowns, 1);
    EXPECT_EQ(second.Shutdowns, 1);
    EXPECT_EQ(stranger.Shutdowns, 0);
}

TEST(RabitManager, AnOrderToShutDownIsNotOverwrittenByALaterPost)
{
    SteppedFixture fixture;
    ScriptedManager &first = fixture.Add("First");
    ScriptedManager &second = fixture.Add("Second");
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    first.ShutdownAllManagers(true);
    first.ShutdownAllManagers(false);
    second.ShutdownManager();
    fixture.RunFor(0s);
    EXPECT_EQ(first.Shutdowns, 1);
    EXPECT_EQ(second.Shutdowns, 1);
}

TEST(RabitManager, AnOldOrderToShutDownDoesNotReachManagersMadeLater)
{
    SteppedFixture fixture;
    ScriptedManager &stays = fixture.Add("Stays");
    stays.ShutdownAllManagers(true);
    ScriptedManager &later = fixture.Add("Later");
    fixture.Reactor.Start();
    fixture.RunFor(1s);
    EXPECT_EQ(stays.Passes, 0);
    EXPECT_EQ(later.Passes, 2);
}

TEST(RabitManager, ShutdownWakesAManagerThatSleepsOnItsThread)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Pilot", workspace);
    manager.SetWakeupTimeDelaySec(1e6);
    manager.Run();
    ASSERT_TRUE(Eventually([&] { return manager.Passes == 1; }));
    manager.ShutdownManager();
    manager.Join();
    EXPECT_EQ(manager.Passes, 1);
    EXPECT_EQ(manager.Shutdowns, 1);
}

TEST(RabitManager, RunsItsThreeStepsOnOneThreadOfItsOwn)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Pilot", workspace);
    std::vector<std::thread::id> threads;
    const auto note = [&] { threads.push_back(std::this_thread::get_id()); };
    manager.OnStartup = note;
    manager.OnShutdown = note;
    manager.OnWork = [&]
    {
        note();
        manager.ShutdownManager();
    };
    manager.Run();
    manager.Join();
    ASSERT_EQ(threads.size(), 3u);
    EXPECT_EQ(threads[0], threads[1]);
    EXPECT_EQ(threads[0], threads[2]);
    EXPECT_NE(threads[0], std::this_thread::get_id());
}

TEST(RabitManager, CannotBeJoinedUnlessStartedNorStartedTwice)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Pilot", workspace);
    EXPECT_THROW(manager.Join(), std::system_error);
    manager.Run();
    EXPECT_THROW(manager.Run(), std::logic_error);
    manager.ShutdownManager();
    manager.Join();
}

TEST(RabitManager, MayRunAgainAfterItWasJoined)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Pilot", workspace);
    for (int run = 1; run <= 3; ++run)
    {
        manager.Run();
        ASSERT_TRUE(Eventually([&] { return manager.Passes >= run; }));
        manager.ShutdownAllManagers(true);
        manager.Join();
        EXPECT_EQ(manager.Shutdowns, run);
    }
}

TEST(RabitManager, PostsItsStatusAsOftenAsTheControlMessagesSay)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Pilot");
    manager.SetWakeupTimeDelayMSec(100);
    fixture.Reactor.Start();
    const auto global = fixture.Workspace.FindGlobalMessage("Pilot:ManagerStatusMessage");
    const auto postsWithin = [&](std::chrono::seconds time)
    {
        const std::uint64_t before = global->GetNumberOfPosts();
        fixture.RunFor(time);
        return global->GetNumberOfPosts() - before;
    };
    EXPECT_EQ(postsWithin(30s), 3u);  // every 10 s
    const auto control = std::make_shared<ManagerControlMessage>();
    fixture.Workspace.AddPublishSubscribeMessage("Pilot:ManagerControlMessage", control);
    control->PublishMgrStatsTime_Sec = 2.0;
    control->PostMessage();
    EXPECT_EQ(postsWithin(30s), 15u);
    control->PublishMgrStatsTime_Sec = 0.0;
    control->PostMessage();
    EXPECT_EQ(postsWithin(30s), 0u);
}

TEST(RabitManager, CountsAndMeasuresItself)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Pilot");
    manager.OnWork = [&] { fixture.Clock->Advance(manager.Passes == 1 ? 100ms : 300ms); };
    fixture.Reactor.Start();
    fixture.RunFor(20s);
    const ManagerStats_t stats = fixture.StatusOf("Pilot")->ManagerStats;
    EXPECT_GT(stats.NumberOfExecuteCycles, 5);
    EXPECT_EQ(stats.TotalNumberOfExecuteCycles, stats.NumberOfExecuteCycles);
    EXPECT_NEAR(stats.MinExecuteUnitOfWorkTime_Sec, 0.1, 1e-9);
    EXPECT_NEAR(stats.MaxExecuteUnitOfWorkTime_Sec, 0.3, 1e-9);
    EXPECT_NEAR(stats.AveSleepTime_Sec, 1.0, 1e-9);
    EXPECT_NEAR(stats.TimeSinceLastStatsReset_Sec,
                stats.TotalExecuteUnitOfWorkTime_Sec + stats.TotalSleepTime_Sec, 1e-9);
}

TEST(RabitManager, ClearsItsStatisticsWhenTheToggleChanges)
{
    SteppedFixture fixture;
    ScriptedManager &manager = fixture.Add("Pilot");
    const auto control = std::make_shared<ManagerControlMessage>();
    fixture.Workspace.AddPublishSubscribeMessage("ManagerControlMessage", control);
    control->PublishMgrStatsTime_Sec = 0.5;
    control->PostMessage();
    fixture.Reactor.Start();
    fixture.RunFor(20s);
    EXPECT_EQ(fixture.StatusOf("Pilot")->ManagerStats.NumberOfExecuteCycles, 21);
    control->ResetMgrStatsToggle = !control->ResetMgrStatsToggle;
    control->PostMessage();
    fixture.RunFor(1s);
    const ManagerStats_t stats = fixture.StatusOf("Pilot")->ManagerStats;
    EXPECT_EQ(stats.NumberOfExecuteCycles, 2);
    EXPECT_EQ(stats.TotalNumberOfExecuteCycles, 23);
    EXPECT_EQ(manager.Passes, 23);
}

TEST(RabitManager, AddsMessagesToQueuesOfOthersAndHearsIfItCannot)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Pilot", workspace);
    ScriptedManager other("Other", workspace);
    const auto message = std::make_shared<NumberMessage>();
    EXPECT_TRUE(manager.AddMessageToQueue("Other", message));
    EXPECT_FALSE(manager.AddMessageToQueue("Nobody", message));
    EXPECT_EQ(other.GetManagerMessageQueue()->NoMessagesInQueue(), 1);
}

TEST(RabitManager, KnowsTheManagersOfTheReactor)
{
    SteppedFixture fixture;
    ScriptedManager &first = fixture.Add("First");
    ScriptedManager &second = fixture.Add("Second");
    fixture.Add("First");
    EXPECT_EQ(first.GetListOfManagerNames(), (std::vector<std::string>{"First", "Second"}));
    EXPECT_EQ(second.GetManagerIndexNumber(), 1);
    EXPECT_EQ(second.GetManagerIndexNumber("First"), 0);
    EXPECT_EQ(second.GetManagerIndexNumber("Nobody"), -1);
    EXPECT_TRUE(first.DoesManagerExist("Second"));
    EXPECT_FALSE(first.DoesManagerExist("Nobody"));
}

}  // namespace
