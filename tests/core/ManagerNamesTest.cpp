// The owners of a manager's names and handlers, from run to run.
#include "CapturedLog.h"
#include "SteppedFixture.h"
#include "TestManagers.h"
#include "TestMessages.h"

#include <rabit/RabitReactor.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace
{

using namespace Rabit;
using namespace RabitTest;

// A manager that runs twice. Before the second run another manager, which stays, has taken its message's
// name.
struct SecondRun
{
    RabitWorkspace Workspace;
    ScriptedManager Staying{"Staying", Workspace};
    RabitReactor Reactor{Workspace};
    ScriptedManager *Running = nullptr;
    std::shared_ptr<NumberMessage> Own = std::make_shared<NumberMessage>();
    std::shared_ptr<NumberMessage> Taken = std::make_shared<NumberMessage>();

    SecondRun()
    {
        auto manager = std::make_unique<ScriptedManager>("Running", Workspace);
        Running = manager.get();
        Running->AddPublishSubscribeMessage("Number", Own);
        Running->OnWork = [this] { Running->ShutdownManager(); };
        Reactor.AddManager(std::move(manager));
    }
    void RunTwice()
    {
        Reactor.Run();
        ASSERT_TRUE(Staying.AddPublishSubscribeMessage("Number", Taken));
        Reactor.Run();
        ASSERT_NE(Workspace.FindGlobalMessage("Number"), nullptr);
        ASSERT_EQ(Own->GetGlobalPublishSubscribeMessageRef(), Workspace.FindGlobalMessage("Number"));
    }
};

TEST(ManagerHandlers, OfTheFirstRunAreCalledInTheSecond)
{
    SecondRun test;
    int calls = 0;
    test.Own->Register_SomethingPublished([&] { ++calls; });
    test.RunTwice();
    test.Taken->PostMessage();
    EXPECT_EQ(calls, 1);
}

TEST(ManagerHandlers, OfTheSecondRunEndWithTheManager)
{
    SecondRun test;
    test.RunTwice();
    auto calls = std::make_shared<int>(0);
    test.Own->Register_SomethingPublished([calls] { ++*calls; });
    test.Reactor = RabitReactor(test.Workspace);  // destroys the manager
    test.Taken->PostMessage();
    EXPECT_EQ(*calls, 0);
    EXPECT_EQ(calls.use_count(), 1) << "the handler is still there";
}

TEST(ManagerHandlers, OfTheFirstRunEndWithTheManagerAfterTheSecond)
{
    SecondRun test;
    auto calls = std::make_shared<int>(0);
    test.Own->Register_SomethingPublished([calls] { ++*calls; });
    test.RunTwice();
    const auto own = test.Own;
    test.Reactor = RabitReactor(test.Workspace);
    test.Taken->PostMessage();
    EXPECT_EQ(*calls, 0);
    EXPECT_EQ(calls.use_count(), 1) << "the handler is still there";
}

TEST(ManagerNames, ASecondManagerOfTheSameNameIsSaidAtOnce)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    const ScriptedManager first("Pilot", workspace);
    EXPECT_TRUE(log.Lines().empty());
    const ScriptedManager other("Copilot", workspace);
    EXPECT_TRUE(log.Lines().empty());
    const ScriptedManager second("Pilot", workspace);
    ASSERT_EQ(log.Lines().size(), 1U);
    EXPECT_NE(log.Lines().front().find("\"Pilot\""), std::string::npos) << log.Lines().front();
}

TEST(ManagerNames, ASuccessorOfTheSameNameIsNothingToSay)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    std::make_unique<ScriptedManager>("Pilot", workspace).reset();
    const ScriptedManager destroyedBefore("Pilot", workspace);
    RabitWorkspace another;
    const ScriptedManager elsewhere("Pilot", another);
    RabitReactor reactor(another);
    EXPECT_TRUE(log.Lines().empty());
}

TEST(ManagerNames, AManagerThatComesBackBesideOneOfItsNameIsSaid)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    auto manager = std::make_unique<ScriptedManager>("Pilot", workspace);
    manager->OnWork = [one = manager.get()] { one->ShutdownManager(); };
    reactor.AddManager(std::move(manager));
    reactor.Run();
    const CapturedLog log;
    const ScriptedManager successor("Pilot", workspace);
    EXPECT_TRUE(log.Lines().empty()) << "the first one has left";
    reactor.Run();
    EXPECT_EQ(log.Lines().size(), 1U);
}

TEST(ManagerNames, OfAManagerThatNeverRanAreForgottenWithIt)
{
    RabitWorkspace workspace;
    {
        RabitReactor reactor(workspace);
        auto manager = std::make_unique<ScriptedManager>("Pilot", workspace);
        manager->AddPublishSubscribeMessage("Number", std::make_shared<NumberMessage>());
        reactor.AddManager(std::move(manager));
        ASSERT_TRUE(workspace.DoesManagerExist("Pilot"));
    }
    EXPECT_TRUE(workspace.GetListOfMessages().empty());
    EXPECT_TRUE(workspace.GetListOfQueues().empty());
    EXPECT_TRUE(workspace.GetListOfManagerNames().empty());
}

TEST(ManagerNames, OfOneThatNeverRanStayIfOthersHaveThem)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    RabitReactor staying(workspace);
    auto first = std::make_unique<ScriptedManager>("Pilot", workspace);
    first->AddPublishSubscribeMessage("Number", std::make_shared<NumberMessage>());
    staying.AddManager(std::move(first));
    {
        RabitReactor reactor(workspace);
        auto manager = std::make_unique<ScriptedManager>("Pilot", workspace);
        manager->AddPublishSubscribeMessage("Number", std::make_shared<NumberMessage>());
        reactor.AddManager(std::move(manager));
    }
    EXPECT_NE(workspace.FindGlobalMessage("Number"), nullptr);
    EXPECT_NE(workspace.FindGlobalMessage("Pilot:ManagerStatusMessage"), nullptr);
    EXPECT_TRUE(workspace.DoesManagerExist("Pilot"));
}

TEST(ManagerNames, OfOneThatRanStayWithWhatItSaidLast)
{
    RabitWorkspace workspace;
    ScriptedManager other("Other", workspace);
    {
        ScriptedManager manager("Pilot", workspace);
        manager.OnWork = [&] { manager.ShutdownManager(); };
        manager.Run();
        manager.Join();
    }
    ManagerStatusMessage status;
    ASSERT_TRUE(workspace.FetchMessage("Pilot:ManagerStatusMessage", &status));
    EXPECT_EQ(status.RunningState, ManagerStatusMessage::MgrState_Shutdown);
}

}  // namespace
