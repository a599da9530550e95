// A suspended computer: this program gives the kernel's clocks the values that they have then.
#include <rabit/PublishSubscribeMessage.h>
#include <rabit/RabitClock.h>

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <memory>

#include "TestMessages.h"

namespace
{

std::atomic<std::time_t> suspended{0};  // seconds in all

}  // namespace

// Replaces the C library's function. CLOCK_MONOTONIC stands still.
extern "C" int clock_gettime(clockid_t clock, std::timespec *time) noexcept
{
    const long result = syscall(SYS_clock_gettime, clock, time);
    if (clock == CLOCK_BOOTTIME || clock == CLOCK_REALTIME)
    {
        time->tv_sec += suspended;
    }
    return static_cast<int>(result);
}

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

constexpr std::time_t Hour = 3600;

TEST(Suspension, IsNotCountedByTheStandardSteadyClock)
{
    const auto before = std::chrono::steady_clock::now();
    suspended += Hour;
    EXPECT_LT(std::chrono::steady_clock::now() - before, 30min)
        << "this test does not see what it is meant to";
}

TEST(Suspension, IsCountedByTheMonotonicClock)
{
    const auto before = RabitClock::System()->Monotonic();
    suspended += Hour;
    EXPECT_GE(RabitClock::System()->Monotonic() - before, 1h);
}

TEST(Suspension, IsCountedByBothClocksOfAPostTime)
{
    const PostTime before = RabitClock::System()->Now();
    suspended += Hour;
    const PostTime after = RabitClock::System()->Now();
    EXPECT_GE(after.Monotonic - before.Monotonic, 1h);
    EXPECT_NEAR(after.GpsTimeSeconds - before.GpsTimeSeconds,
                std::chrono::duration<double>(after.Monotonic - before.Monotonic).count(), 0.1);
}

TEST(Suspension, MakesWhatWasPostedBeforeItAsOldAsItIs)
{
    RabitTest::NumberMessage message;
    message.SetGlobalPublishSubscribeMessageRef(std::make_shared<PublishSubscribeMessage>(message.Clone()));
    message.PostMessage();
    suspended += Hour;
    EXPECT_GE(message.GetAgeSeconds(), 3600.0);
}

}  // namespace
}  // namespace Rabit
