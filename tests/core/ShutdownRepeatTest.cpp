// Signals that come more than once: this program says how late the kernel's monotonic clock is.
#include "TestManagers.h"

#include <rabit/RabitReactor.h>

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <string>
#include <thread>
#include <utility>

namespace
{

std::atomic<std::int64_t> held{0};  // what the clock says, in ns; 0: the true time

}  // namespace

// Replaces the C library's function.
extern "C" int clock_gettime(clockid_t clock, std::timespec *time) noexcept
{
    if (const std::int64_t now = held; now != 0 && clock == CLOCK_MONOTONIC)
    {
        time->tv_sec = now / 1'000'000'000;
        time->tv_nsec = now % 1'000'000'000;
        return 0;
    }
    return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
}

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

// A reactor with one manager, whose Shutdown waits until it may go on.
class ShutdownRepeatDeathTest : public testing::TestWithParam<int>
{
protected:
    static void HoldClockAt(std::chrono::nanoseconds time) { held = (1h + time).count(); }

    void SetUp() override
    {
        GTEST_FLAG_SET(death_test_style, "threadsafe");
        signal(GetParam(), SIG_DFL);  // nohup has SIGHUP ignored
    }

    // Calls the function while the manager is in its Shutdown after a first signal. Ends the process with 0
    // if the reactor then ends in order.
    template <typename During>
    [[noreturn]] static void AfterTheFirstSignal(During during)
    {
        RabitWorkspace workspace;
        RabitReactor reactor(workspace);
        auto made = std::make_unique<ScriptedManager>("Manager", workspace);
        ScriptedManager &manager = *made;
        std::atomic<bool> isShuttingDown{false};
        std::atomic<bool> mayEnd{false};
        manager.OnShutdown = [&]
        {
            isShuttingDown = true;
            mayEnd.wait(false);
        };
        reactor.AddManager(std::move(made));
        std::thread thread([&] { reactor.Run(); });
        Eventually([&] { return manager.Passes > 0; });
        HoldClockAt(0s);
        raise(GetParam());
        held = 0;
        Eventually([&] { return isShuttingDown.load(); });
        during();
        held = 0;
        mayEnd = true;
        mayEnd.notify_all();
        thread.join();
        std::_Exit(manager.Shutdowns == 1 ? 0 : 1);
    }
};

TEST_P(ShutdownRepeatDeathTest, OneThatComesTwiceAtOnceIsOne)
{
    EXPECT_EXIT(AfterTheFirstSignal(
                    []
                    {
                        HoldClockAt(1ms);
                        raise(GetParam());
                        raise(SIGTERM);
                        HoldClockAt(499ms);
                        raise(GetParam());
                    }),
                testing::ExitedWithCode(0), "");
}

TEST_P(ShutdownRepeatDeathTest, OneThatComesHalfASecondLaterEndsTheProcess)
{
    EXPECT_EXIT(AfterTheFirstSignal(
                    []
                    {
                        HoldClockAt(500ms);
                        raise(GetParam());
                    }),
                testing::KilledBySignal(GetParam()), "");
}

INSTANTIATE_TEST_SUITE_P(Signals, ShutdownRepeatDeathTest, testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const testing::TestParamInfo<int> &tested)
                         { return std::string(sigabbrev_np(tested.param)); });

}  // namespace
