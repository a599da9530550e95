// Shutdown orders from threads that do not know whether the manager is starting, running or ending.
#include "TestManagers.h"

#include <rabit/RabitReactor.h>

#include <gtest/gtest.h>

#include <atomic>
#include <exception>
#include <memory>
#include <string>
#include <thread>

namespace
{

using namespace Rabit;
using namespace RabitTest;

// Lets a thread call a function again and again while it lives. Records the exceptions of the calls.
class Repeating
{
public:
    template <typename Call>
    explicit Repeating(Call call)
        : _thread(
              [this, call]
              {
                  while (!_stop)
                  {
                      try
                      {
                          call();
                          ++Calls;
                      }
                      catch (const std::exception &error)
                      {
                          Thrown = error.what();
                          return;
                      }
                  }
              })
    {
    }
    ~Repeating()
    {
        _stop = true;
        _thread.join();
    }
    std::atomic<int> Calls{0};
    std::string Thrown;

private:
    std::atomic<bool> _stop{false};
    std::thread _thread;
};

TEST(OrderToShutDown, OfAllManagersFromAnotherThreadIsSafeWhileRunsStartAndEnd)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Manager", workspace);
    ScriptedManager neighbour("Neighbour", workspace);
    manager.SetWakeupTimeDelaySec(1e6);
    std::string thrown;
    {
        Repeating ordering([&] { manager.ShutdownAllManagers(true); });
        for (int run = 0; run < 2000; ++run)
        {
            manager.Run();
            manager.Join();
        }
        ASSERT_TRUE(Eventually([&] { return ordering.Calls > 0 || !ordering.Thrown.empty(); }));
        thrown = ordering.Thrown;
    }
    EXPECT_EQ(thrown, "");
    EXPECT_EQ(manager.Shutdowns, 2000);
}

TEST(OrderToShutDown, OfAllManagersBetweenTwoRunsOfAReactorHoldsForTheSecond)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    const auto add = [&](const char *name)
    {
        auto manager = std::make_unique<ScriptedManager>(name, workspace);
        ScriptedManager *const added = manager.get();
        added->SetWakeupTimeDelaySec(1e6);
        added->OnWork = [added] { added->ShutdownManager(); };
        reactor.AddManager(std::move(manager));
        return added;
    };
    ScriptedManager *const first = add("First");
    ScriptedManager *const second = add("Second");
    reactor.Run();
    ASSERT_EQ(first->Passes + second->Passes, 2);
    first->ShutdownAllManagers(true);
    reactor.Run();
    EXPECT_EQ(first->Startups + second->Startups, 4);
    EXPECT_EQ(first->Passes + second->Passes, 2) << "a unit of work ran in spite of the order";
}

TEST(OrderToShutDown, OfAReactorIsSafeWhileManagersAreAdded)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    {
        Repeating ordering([&] { reactor.ShutdownAllManagers(); });
        for (int i = 0; i < 300; ++i)
        {
            reactor.AddManager(std::make_unique<ScriptedManager>("Manager" + std::to_string(i), workspace));
        }
        EXPECT_TRUE(Eventually([&] { return ordering.Calls > 0; }));
    }
    reactor.ShutdownAllManagers();
    reactor.Run();
    EXPECT_EQ(workspace.GetListOfManagerNames().size(), 300U);
}

}  // namespace
