#include "CapturedLog.h"
#include "TestManagers.h"

#include <rabit/RabitLog.h>
#include <rabit/RabitReactor.h>

#include <gtest/gtest.h>

#include <malloc.h>

#include <stdexcept>
#include <string>

namespace
{

using namespace Rabit;
using namespace RabitTest;

TEST(RabitLog, WritesWarningsAndErrorsToStderrAndNothingElse)
{
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    RabitLog::Write(RabitLogLevel::Debug, "one");
    RabitLog::Write(RabitLogLevel::Info, "two");
    RabitLog::Write(RabitLogLevel::Warning, "three");
    RabitLog::Write(RabitLogLevel::Error, "four");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "rabit: warning: three\nrabit: error: four\n");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(RabitLog, PutsTheNameOfTheProgramBeforeLinesOnStderr)
{
    testing::internal::CaptureStderr();
    RabitLog::SetName("uav1");
    RabitLog::Write(RabitLogLevel::Warning, "one");
    RabitLog::SetName("uav\x1b\n2");
    RabitLog::Write(RabitLogLevel::Error, "two");
    RabitLog::SetName("rabit");
    RabitLog::Write(RabitLogLevel::Warning, "three");
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "uav1: warning: one\nuav??2: error: two\nrabit: warning: three\n");
}

TEST(RabitLog, AManagersLineHasItsName)
{
    const CapturedLog log;
    RabitWorkspace workspace;
    ScriptedManager manager("Pilot", workspace);
    manager.WriteLog(RabitLogLevel::Info, "below the level");
    manager.WriteLog(RabitLogLevel::Warning, "no fix");
    EXPECT_EQ(log.Lines(), std::vector<std::string>{"Pilot: no fix"});
}

TEST(RabitLog, GivesLinesToTheSinkOfTheProgramAndNotToStderr)
{
    testing::internal::CaptureStderr();
    {
        const CapturedLog log;
        RabitLog::Write(RabitLogLevel::Error, "kept");
        EXPECT_EQ(log.Lines(), std::vector<std::string>{"kept"});
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(RabitLog, KeepsNothingOfListenersThatAreGoneThoughNothingIsLogged)
{
    const auto bytesInUse = [] { return mallinfo2().uordblks; };
    const std::size_t before = bytesInUse();
    for (int i = 0; i < 10000; ++i)
    {
        static_cast<void>(RabitLog::Listen([](RabitLogLevel, const std::string &) {}));
    }
    EXPECT_LT(bytesInUse(), before + 100000);
}

TEST(RabitLog, TellsListenersBesideTheSinkForAsLongAsTheyAreKept)
{
    const CapturedLog log;
    std::vector<std::string> heard;
    {
        const std::shared_ptr<void> listener = RabitLog::Listen(
            [&heard](RabitLogLevel level, const std::string &text)
            {
                heard.push_back(text);
                EXPECT_EQ(level, RabitLogLevel::Error);
                throw std::runtime_error("no matter");
            });
        RabitLog::Write(RabitLogLevel::Error, "one");
        RabitLog::Write(RabitLogLevel::Debug, "below the level");
    }
    RabitLog::Write(RabitLogLevel::Error, "two");
    EXPECT_EQ(heard, std::vector<std::string>{"one"});
    EXPECT_EQ(log.Lines(), (std::vector<std::string>{"one", "two"}));
}

TEST(RabitLog, ALineHasNoControlCharacters)
{
    std::vector<std::string> heard;
    const std::shared_ptr<void> listener =
        RabitLog::Listen([&heard](RabitLogLevel, const std::string &text) { heard.push_back(text); });
    const CapturedLog log;
    RabitLog::Write(RabitLogLevel::Error, "H\xc3\xb6he of uav1\x1b[2J\n\x7f" + std::string(1, '\0') + "2");
    const std::vector<std::string> expected{"H\xc3\xb6he of uav1?[2J???2"};
    EXPECT_EQ(log.Lines(), expected);
    EXPECT_EQ(heard, expected);
}

TEST(RabitLog, TheLevelIsAThreshold)
{
    const CapturedLog log;
    RabitLog::SetLevel(RabitLogLevel::Info);
    RabitLog::Write(RabitLogLevel::Debug, "debug");
    RabitLog::Write(RabitLogLevel::Info, "info");
    RabitLog::SetLevel(RabitLogLevel::Off);
    RabitLog::Write(RabitLogLevel::Error, "error");
    RabitLog::SetLevel(RabitLogLevel::Warning);
    EXPECT_EQ(log.Lines(), std::vector<std::string>{"info"});
}

TEST(RabitLog, ASinkThatThrowsCostsNoLine)
{
    testing::internal::CaptureStderr();
    RabitLog::SetSink([](RabitLogLevel, const std::string &) { throw std::runtime_error("broken sink"); });
    RabitLog::Write(RabitLogLevel::Error, "still here");
    RabitLog::SetSink(nullptr);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "rabit: error: still here\n");
}

TEST(RabitLog, AReactorThatRunsWellPrintsNothing)
{
    class Quiet : public RabitManager
    {
    public:
        explicit Quiet(RabitWorkspace &workspace) : RabitManager("Quiet", workspace) {}
        void ExecuteUnitOfWork() final { ShutdownAllManagers(true); }
    };
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    RabitWorkspace workspace;
    RabitReactor reactor(workspace);
    reactor.AddManager(std::make_unique<Quiet>(workspace));
    reactor.Run();
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
