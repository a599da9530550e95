#include "CapturedLog.h"
#include "TestManagers.h"
#include "TestMessages.h"

#include <rabit/RabitReactor.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace
{

using namespace Rabit;
using namespace RabitTest;

ScriptedManager &AddTo(RabitReactor &reactor, RabitWorkspace &workspace, const std::string &name)
{
    auto manager = std::make_unique<ScriptedManager>(name, workspace);
    ScriptedManager &added = *manager;
    reactor.AddManager(std::move(manager));
    return added;
}

TEST(RabitReactor, RunsManagersUntilTheyAreToldToShutDown)
{
    RabitWorkspace workspace;
    auto reactor = RabitReactor(workspace);
    ScriptedManager &first = AddTo(reactor, workspace, "First");
    ScriptedManager &second = AddTo(reactor, workspace, "Second");
    second.SetWakeupTimeDelaySec(1e6);
    first.OnWork = [&]
    {
        if (second.Passes > 0)
        {
            first.ShutdownAllManagers(true);
        }
        first.SetWakeupTimeDelayMSec(1);
    };
    reactor.Run();
    for (const ScriptedManager *manager : {&first, &second})
    {
        EXPECT_EQ(manager->Startups, 1);
        EXPECT_GE(manager->Passes, 1);
        EXPECT_EQ(manager->Shutdowns, 1);
    }
}

TEST(RabitReactor, ReturnsAtOnceWithoutManagers)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    reactor.AddManager(nullptr);
    std::atomic<bool> returned{false};
    std::thread running(
        [&]
        {
            reactor.Run();
            returned = true;
        });
    const bool byItself = Eventually([&] { return returned.load(); });
    reactor.ShutdownAllManagers();
    EXPECT_TRUE(byItself);
    running.join();
    EXPECT_TRUE(workspace.GetListOfManagerNames().empty());
}

TEST(RabitReactor, IsShutDownFromAnotherThreadThoughItsManagersSleepLong)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    ScriptedManager &manager = AddTo(reactor, workspace, "Manager");
    manager.SetWakeupTimeDelaySec(1e6);
    std::thread running([&] { reactor.Run(); });
    ASSERT_TRUE(Eventually([&] { return manager.Passes == 1; }));
    reactor.ShutdownAllManagers();
    running.join();
    EXPECT_EQ(manager.Shutdowns, 1);
}

TEST(RabitReactor, AnOrderToShutDownThatComesBeforeRunIsNotLost)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    ScriptedManager &manager = AddTo(reactor, workspace, "Manager");
    reactor.ShutdownAllManagers();
    reactor.Run();
    EXPECT_EQ(manager.Startups, 1);
    EXPECT_EQ(manager.Shutdowns, 1);
}

TEST(RabitReactor, MayRunAgainWithNamesAndWakeUpsInPlace)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    ScriptedManager &sender = AddTo(reactor, workspace, "Sender");
    ScriptedManager &receiver = AddTo(reactor, workspace, "Receiver");
    receiver.SetWakeupTimeDelaySec(1e6);
    const auto sent = std::make_shared<NumberMessage>();
    const auto received = std::make_shared<NumberMessage>();
    sender.AddPublishSubscribeMessage("Number", sent);
    receiver.AddPublishSubscribeMessage("Number", received);
    receiver.WakeUpManagerOnMessagePost(received);
    sender.OnStartup = [&]
    {
        ++sent->Number;
        sent->PostMessage();
        EXPECT_TRUE(sender.AddMessageToQueue("Receiver", sent->Clone()));
    };
    receiver.OnWork = [&]
    {
        std::shared_ptr<RabitMessage> message;
        if (receiver.GetManagerMessageQueue()->GetMessage(message))
        {
            EXPECT_TRUE(received->FetchMessage());
            receiver.ShutdownAllManagers(true);
        }
    };
    for (int run = 1; run <= 3; ++run)
    {
        reactor.Run();
        EXPECT_EQ(received->Number, run);
        EXPECT_EQ(receiver.Shutdowns, run);
        EXPECT_EQ(workspace.FindQueue("Receiver"), nullptr);
        EXPECT_EQ(workspace.FindGlobalMessage("Number"), nullptr);
    }
}

TEST(RabitReactor, TakesMoreManagersBetweenTwoRuns)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    ScriptedManager &first = AddTo(reactor, workspace, "First");
    first.OnWork = [&] { first.ShutdownAllManagers(true); };
    reactor.Run();
    ScriptedManager &second = AddTo(reactor, workspace, "Second");
    reactor.Run();
    EXPECT_EQ(first.Shutdowns, 2);
    EXPECT_EQ(second.Shutdowns, 1);
}

TEST(RabitReactor, OneThatEndsLeavesTheNamesOfAnotherAlone)
{
    RabitWorkspace workspace;
    RabitReactor ending(workspace);
    RabitReactor staying(workspace);
    ScriptedManager &gone = AddTo(ending, workspace, "Gone");
    AddTo(staying, workspace, "Stays");
    const auto shared = std::make_shared<NumberMessage>();
    gone.AddPublishSubscribeMessage("Shared", shared);
    staying.AddManager(nullptr);
    workspace.AddManagerMessageQueue("Nobodys", std::make_shared<RabitMessageQueue<int>>(1, "Nobodys"));
    gone.OnWork = [&] { gone.ShutdownManager(); };
    ending.Run();
    EXPECT_EQ(workspace.FindQueue("Gone"), nullptr);
    EXPECT_EQ(workspace.FindGlobalMessage("Shared"), nullptr);
    EXPECT_NE(workspace.FindQueue("Stays"), nullptr);
    EXPECT_NE(workspace.FindQueue("Nobodys"), nullptr);
    EXPECT_NE(workspace.FindGlobalMessage("Stays:ManagerStatusMessage"), nullptr);
    EXPECT_NE(workspace.FindGlobalMessage("ManagerControlMessage"), nullptr);
}

TEST(RabitReactor, TheLastOneThatEndsForgetsAllNames)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    ScriptedManager &manager = AddTo(reactor, workspace, "Manager");
    manager.OnWork = [&] { manager.ShutdownManager(); };
    workspace.AddPublishSubscribeMessage("Nobodys", std::make_shared<NumberMessage>());
    reactor.Run();
    EXPECT_TRUE(workspace.GetListOfMessages().empty());
    EXPECT_TRUE(workspace.GetListOfQueues().empty());
    EXPECT_TRUE(workspace.DoesManagerExist("Manager"));
}

TEST(RabitReactor, TwoSideBySideLoseNoneOfTenThousandMessages)
{
    constexpr int count = 10000;
    RabitWorkspace workspace;
    RabitReactor sending(workspace);
    RabitReactor receiving(workspace);
    RabitReactor comingAndGoing(workspace);
    ScriptedManager &sender = AddTo(sending, workspace, "Sender");
    ScriptedManager &receiver = AddTo(receiving, workspace, "Receiver");
    ScriptedManager &short_lived = AddTo(comingAndGoing, workspace, "ShortLived");
    short_lived.OnWork = [&] { short_lived.ShutdownManager(); };
    receiver.SetWakeupTimeDelaySec(1e6);
    sender.SetWakeupTimeDelayMSec(0);
    int next = 0;
    sender.OnWork = [&]
    {
        auto message = std::make_shared<NumberMessage>();
        message->Number = next;
        if (sender.AddMessageToQueue("Receiver", message) && ++next == count)
        {
            sender.ShutdownManager();
        }
    };
    std::vector<int> received;
    receiver.OnWork = [&]
    {
        std::shared_ptr<RabitMessage> message;
        while (receiver.GetManagerMessageQueue()->GetMessage(message))
        {
            received.push_back(static_cast<NumberMessage &>(*message).Number);
        }
        if (received.size() == static_cast<std::size_t>(count))
        {
            receiver.ShutdownManager();
        }
    };
    std::thread receivingThread([&] { receiving.Run(); });
    std::thread sendingThread([&] { sending.Run(); });
    for (int i = 0; i < 50; ++i)
    {
        comingAndGoing.Run();
    }
    sendingThread.join();
    receivingThread.join();
    ASSERT_EQ(received.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
    {
        ASSERT_EQ(received[static_cast<std::size_t>(i)], i);
    }
}

TEST(RabitReactor, MayBeMovedBeforeItRuns)
{
    RabitWorkspace workspace;
    RabitReactor made(workspace);
    ScriptedManager &manager = AddTo(made, workspace, "Manager");
    manager.OnWork = [&] { manager.ShutdownManager(); };
    RabitReactor moved(std::move(made));
    moved.Run();
    EXPECT_EQ(manager.Shutdowns, 1);
    RabitReactor assigned(workspace);
    assigned = std::move(moved);
    assigned.Run();
    EXPECT_EQ(manager.Shutdowns, 2);
    EXPECT_THROW(moved.Run(), std::logic_error);  // NOLINT(bugprone-use-after-move): that is what is tested
}

TEST(RabitReactor, RefusesManagersOfAnotherWorkspace)
{
    RabitWorkspace workspace;
    RabitWorkspace other;
    RabitReactor reactor(workspace);
    EXPECT_THROW(reactor.AddManager(std::make_unique<ScriptedManager>("Stranger", other)),
                 std::invalid_argument);
}

TEST(RabitReactor, RefusesToRunTwiceAtOnceAndToTakeManagersWhileItRuns)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    ScriptedManager &manager = AddTo(reactor, workspace, "Manager");
    bool refusedRun = false;
    bool refusedManager = false;
    manager.OnWork = [&]
    {
        try
        {
            reactor.Run();
        }
        catch (const std::logic_error &)
        {
            refusedRun = true;
        }
        try
        {
            AddTo(reactor, workspace, "Late");
        }
        catch (const std::logic_error &)
        {
            refusedManager = true;
        }
        manager.ShutdownManager();
    };
    reactor.Run();
    EXPECT_TRUE(refusedRun);
    EXPECT_TRUE(refusedManager);
}

TEST(RabitReactor, SaysForWhichManagerItWaits)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    reactor.SetPatience(std::chrono::milliseconds(1));
    ScriptedManager &hanging = AddTo(reactor, workspace, "Hanging");
    ScriptedManager &healthy = AddTo(reactor, workspace, "Healthy");
    const auto isSaid = [&]
    {
        const auto lines = log.Lines();
        return std::any_of(lines.begin(), lines.end(),
                           [](const std::string &line)
                           {
                               return line.find("waits for manager \"Hanging\"") != std::string::npos &&
                                      line.find("in ExecuteUnitOfWork") != std::string::npos;
                           });
    };
    hanging.OnWork = [&]
    {
        reactor.ShutdownAllManagers();
        EXPECT_TRUE(Eventually([&] { return isSaid() && healthy.Shutdowns == 1; }));
    };
    reactor.Run();
    EXPECT_TRUE(isSaid());
}

TEST(RabitReactor, SaysNothingOfAManagerThatWasNotToldToShutDown)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    reactor.SetPatience(std::chrono::milliseconds(1));
    ScriptedManager &told = AddTo(reactor, workspace, "Told");
    ScriptedManager &other = AddTo(reactor, workspace, "Other");
    std::atomic<bool> isOver{false};
    const auto lines = [&log](const std::string &manager)
    {
        const auto all = log.Lines();
        return std::count_if(all.begin(), all.end(),
                             [&manager](const std::string &line)
                             { return line.find("\"" + manager + "\"") != std::string::npos; });
    };
    told.OnWork = [&]
    {
        EXPECT_TRUE(Eventually([&] { return other.Passes == 1; }));
        told.ShutdownManager();
        EXPECT_TRUE(Eventually([&] { return lines("Told") >= 3; }));
        EXPECT_EQ(lines("Other"), 0) << "it is in its step for longer";
        isOver = true;
        other.ShutdownManager();
    };
    other.OnWork = [&] { EXPECT_TRUE(Eventually([&] { return isOver.load(); })); };
    reactor.Run();
}

TEST(RabitReactor, DestroysItsManagersInReverseOrder)
{
    class Noting : public RabitManager
    {
    public:
        Noting(std::string name, RabitWorkspace &workspace, std::string &order)
            : RabitManager(std::move(name), workspace), _order(order)
        {
        }
        ~Noting() override { _order += GetManagerName(); }
        void ExecuteUnitOfWork() final {}

    private:
        std::string &_order;
    };
    std::string order;
    RabitWorkspace workspace;
    {
        RabitReactor reactor(workspace);
        reactor.AddManager(std::make_unique<Noting>("a", workspace, order));
        reactor.AddManager(std::make_unique<Noting>("b", workspace, order));
    }
    EXPECT_EQ(order, "ba");
}

TEST(RabitReactor, WorksInTheDefaultWorkspace)
{
    class Default : public RabitManager
    {
    public:
        Default() : RabitManager("DefaultWorkspaceManager") {}
        void ExecuteUnitOfWork() final { ShutdownAllManagers(true); }
    };
    auto reactor = RabitReactor();
    reactor.AddManager(std::make_unique<Default>());
    EXPECT_TRUE(RabitWorkspace::GetWorkspace()->DoesManagerExist("DefaultWorkspaceManager"));
    reactor.Run();
}

}  // namespace
