#include "TestMessages.h"

#include <rabit/RabitReactor.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

namespace
{

using namespace Rabit;

// Runs for a number of passes, then has everybody shut down.
class CountingManager : public RabitManager
{
public:
    CountingManager(std::string name, RabitWorkspace &workspace, int passes)
        : RabitManager(std::move(name), workspace), _passes(passes)
    {
        SetWakeupTimeDelayMSec(0);
    }
    void Startup() final { ++Startups; }
    void ExecuteUnitOfWork() final
    {
        if (++Passes % _passes == 0)
        {
            ShutdownAllManagers(true);
        }
    }
    void Shutdown() final { ++Shutdowns; }

    int Startups = 0;
    int Passes = 0;
    int Shutdowns = 0;

private:
    const int _passes;
};

TEST(RabitReactor, RunsManagersUntilTheyAreToldToShutDown)
{
    RabitWorkspace workspace;
    auto reactor = RabitReactor(workspace);
    auto manager = std::make_unique<CountingManager>("Counter", workspace, 5);
    const CountingManager &counter = *manager;
    reactor.AddManager(std::move(manager));
    reactor.Run();
    EXPECT_EQ(counter.Startups, 1);
    EXPECT_EQ(counter.Passes, 5);
    EXPECT_EQ(counter.Shutdowns, 1);
}

TEST(RabitReactor, MayRunAgain)
{
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    auto manager = std::make_unique<CountingManager>("Counter", workspace, 5);
    const CountingManager &counter = *manager;
    reactor.AddManager(std::move(manager));
    for (int run = 1; run <= 3; ++run)
    {
        reactor.Run();
        EXPECT_EQ(counter.Startups, run);
        EXPECT_EQ(counter.Passes, 5 * run);
        EXPECT_EQ(counter.Shutdowns, run);
    }
}

TEST(RabitReactor, ForgetsTheNamesOfItsManagersWhenRunEndsAndHasThemBackInTheNext)
{
    class Looking : public RabitManager
    {
    public:
        explicit Looking(RabitWorkspace &workspace) : RabitManager("Looking", workspace) {}
        void ExecuteUnitOfWork() final
        {
            Found = GetWorkspace().FindQueue("Looking") != nullptr &&
                    GetWorkspace().FindGlobalMessage("Looking:ManagerStatusMessage") != nullptr;
            ShutdownManager();
        }
        bool Found = false;
    };
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    auto manager = std::make_unique<Looking>(workspace);
    Looking &looking = *manager;
    reactor.AddManager(std::move(manager));
    for (int run = 0; run < 2; ++run)
    {
        looking.Found = false;
        reactor.Run();
        EXPECT_TRUE(looking.Found);
        EXPECT_EQ(workspace.FindQueue("Looking"), nullptr);
        EXPECT_EQ(workspace.FindGlobalMessage("Looking:ManagerStatusMessage"), nullptr);
    }
}

}  // namespace
