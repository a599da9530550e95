#include "TestManagers.h"

#include <rabit/RabitReactor.h>

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include <unistd.h>
#include <csignal>
#include <cstring>

namespace
{

using namespace Rabit;
using namespace RabitTest;

// A reactor that runs two managers on a thread of its own until something ends it.
struct RunningReactor
{
    RabitWorkspace Workspace;
    RabitReactor Reactor{Workspace};
    ScriptedManager *First = nullptr;
    ScriptedManager *Second = nullptr;
    std::thread Thread;

    explicit RunningReactor(bool handleSignals = true)
    {
        auto first = std::make_unique<ScriptedManager>("First", Workspace);
        auto second = std::make_unique<ScriptedManager>("Second", Workspace);
        First = first.get();
        Second = second.get();
        First->SetWakeupTimeDelaySec(1e6);
        Second->SetWakeupTimeDelaySec(1e6);
        Reactor.AddManager(std::move(first));
        Reactor.AddManager(std::move(second));
        Reactor.SetHandleSignals(handleSignals);
        Thread = std::thread([this] { Reactor.Run(); });
        Eventually([this] { return First->Passes > 0 && Second->Passes > 0; });
    }
    ~RunningReactor()
    {
        Reactor.ShutdownAllManagers();
        if (Thread.joinable())
        {
            Thread.join();
        }
    }
};

class ShutdownSignal : public testing::TestWithParam<int>
{
protected:
    void SetUp() override { signal(GetParam(), SIG_DFL); }  // nohup has SIGHUP ignored
};

TEST_P(ShutdownSignal, EndsRunAfterEveryManagersShutdown)
{
    RunningReactor running;
    kill(getpid(), GetParam());
    running.Thread.join();
    EXPECT_EQ(running.First->Shutdowns, 1);
    EXPECT_EQ(running.Second->Shutdowns, 1);
}

TEST_P(ShutdownSignal, EndsAllReactorsOfTheProcess)
{
    RunningReactor one;
    RunningReactor two;
    kill(getpid(), GetParam());
    one.Thread.join();
    two.Thread.join();
    EXPECT_EQ(one.First->Shutdowns, 1);
    EXPECT_EQ(two.First->Shutdowns, 1);
}

TEST_P(ShutdownSignal, IsHandledInEachOfSeveralRuns)
{
    for (int run = 0; run < 3; ++run)
    {
        RunningReactor running;
        kill(getpid(), GetParam());
        running.Thread.join();
        EXPECT_EQ(running.First->Shutdowns, 1);
    }
}

TEST_P(ShutdownSignal, ThatTheProgramHandlesItselfIsLeftAlone)
{
    static std::atomic<int> handled;
    handled = 0;
    struct sigaction own = {};
    struct sigaction former = {};
    own.sa_handler = [](int) { ++handled; };
    sigaction(GetParam(), &own, &former);
    {
        RunningReactor running;
        kill(getpid(), GetParam());
        EXPECT_TRUE(Eventually([] { return handled == 1; }));
        EXPECT_EQ(running.First->Shutdowns, 0);
    }
    sigaction(GetParam(), &former, nullptr);
}

TEST_P(ShutdownSignal, HasItsDefaultActionAgainWhenTheLastRunEnded)
{
    {
        RunningReactor running;
    }
    struct sigaction current = {};
    sigaction(GetParam(), nullptr, &current);
    EXPECT_EQ(current.sa_handler, SIG_DFL);
}

class ShutdownSignalDeathTest : public ShutdownSignal
{
};

TEST_P(ShutdownSignalDeathTest, LaterOnesEndTheProcess)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            RunningReactor running;
            std::atomic<bool> shuttingDown{false};
            running.First->OnShutdown = [&]
            {
                shuttingDown = true;
                for (;;)
                {
                    pause();  // a Shutdown that never returns
                }
            };
            kill(getpid(), GetParam());
            Eventually([&] { return shuttingDown.load(); });
            for (;;)
            {
                kill(getpid(), GetParam());
            }
        },
        testing::KilledBySignal(GetParam()), "");
}

TEST_P(ShutdownSignal, ThatIsIgnoredAsAfterNohupStaysIgnored)
{
    signal(GetParam(), SIG_IGN);
    {
        RunningReactor running;
        kill(getpid(), GetParam());
        EXPECT_EQ(running.First->Shutdowns, 0);
    }
    EXPECT_EQ(signal(GetParam(), SIG_DFL), SIG_IGN);
}

TEST_P(ShutdownSignalDeathTest, EndsTheProcessWhenTheProgramSwitchedTheHandlersOff)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            RunningReactor running(false);
            kill(getpid(), GetParam());
            for (;;)
            {
                pause();
            }
        },
        testing::KilledBySignal(GetParam()), "");
}

std::string NameOfSignal(const testing::TestParamInfo<int> &tested)
{
    return sigabbrev_np(tested.param);
}

INSTANTIATE_TEST_SUITE_P(Signals, ShutdownSignal, testing::Values(SIGINT, SIGTERM, SIGHUP), NameOfSignal);
INSTANTIATE_TEST_SUITE_P(Signals, ShutdownSignalDeathTest, testing::Values(SIGINT, SIGTERM, SIGHUP),
                         NameOfSignal);

}  // namespace
