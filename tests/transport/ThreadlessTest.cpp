// A session that cannot start one of its threads says so, and leaves nothing behind that is still called.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <rabit/transport/TransportFactory.h>

#include <cerrno>
#include <memory>
#include <string>
#include <thread>
#include <typeinfo>

#include "DomainLease.h"

namespace ThreadsOfStd
{

// Stands for std::thread::_State, which is private from GCC 14 on: an object with virtual functions. Not in
// the namespace without a name, where clang wants its functions to be defined.
class ThreadState
{
public:
    virtual ~ThreadState();
};

}  // namespace ThreadsOfStd

namespace
{

using StartRoutine = void *(*)(void *);
using Create = int (*)(pthread_t *, const pthread_attr_t *, StartRoutine, void *);

thread_local int left = -1;         // threads of Rabit's that may still start; negative: all
thread_local bool isProbe = false;  // the next thread tells how std::thread starts one
StartRoutine routineOfStdThread = nullptr;

bool IsOfRabit(StartRoutine routine, void *argument)
{
    if (routine != routineOfStdThread)
    {
        return false;
    }
    const auto *const state = static_cast<const ThreadsOfStd::ThreadState *>(argument);
    return std::string(typeid(*state).name()).find("Rabit") != std::string::npos;
}

}  // namespace

// In place of the C library's.
extern "C" int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, StartRoutine routine,
                              void *argument)
{
    static const auto real = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
    if (isProbe)
    {
        routineOfStdThread = routine;
    }
    if (left >= 0 && IsOfRabit(routine, argument) && --left < 0)
    {
        left = 0;
        return EAGAIN;
    }
    return real(thread, attributes, routine, argument);
}

namespace
{

class ThreadlessTest : public testing::TestWithParam<std::string>
{
protected:
    ThreadlessTest()
    {
        isProbe = true;
        std::thread([] {}).join();
        isProbe = false;
        Settings.Node = "uav1";
        Settings.Domain = Rabit::Conformance::OwnDomain();
        Settings.Interfaces = {"lo"};
    }
    // Opens a session that can start so many threads. Returns what it says if it cannot be opened.
    std::string OpenWith(int threads)
    {
        left = threads;
        std::string why;
        try
        {
            Rabit::MakeTransport(GetParam())->Open(Settings, nullptr);
        }
        catch (const Rabit::TransportError &error)
        {
            why = error.what();
        }
        left = -1;
        return why;
    }

    Rabit::TransportSettings Settings;
};

TEST_P(ThreadlessTest, ASessionTellsThatAThreadCannotBeStartedAndTheNextOneOpens)
{
    int threads = 0;
    for (std::string why = OpenWith(threads); !why.empty(); why = OpenWith(threads))
    {
        EXPECT_NE(why.find("a thread cannot be started"), std::string::npos) << why;
        ++threads;
        ASSERT_LT(threads, 20);
    }
    EXPECT_GT(threads, 0);
    EXPECT_EQ(OpenWith(-1), "");
}

INSTANTIATE_TEST_SUITE_P(Backends, ThreadlessTest, testing::ValuesIn(Rabit::AvailableTransports()),
                         [](const auto &backend) { return backend.param; });

}  // namespace
