#include "ScreenLog.h"

#include <rabit/RabitLog.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace
{
using Ground::ScreenLog;
using Rabit::RabitLog;
using Rabit::RabitLogLevel;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(ScreenLog, KeepsWhatIsLoggedForWhoeverDrawsTheScreen)
{
    const ScreenLog log;
    RabitLog::Write(RabitLogLevel::Warning, "one");
    RabitLog::Write(RabitLogLevel::Warning, "two");
    EXPECT_THAT(log.Take(), ElementsAre("one", "two"));
    EXPECT_THAT(log.Take(), IsEmpty());
}

TEST(ScreenLog, IsBoundedAndSaysHowManyLinesAreMissing)
{
    const ScreenLog log;
    for (std::size_t i = 0; i < ScreenLog::MaxLines + 3; ++i)
        RabitLog::Write(RabitLogLevel::Warning, "line");
    const auto lines = log.Take();
    ASSERT_EQ(lines.size(), ScreenLog::MaxLines + 1);
    EXPECT_EQ(lines.back(), "... and 3 lines more");
}

TEST(ScreenLog, GivesTheStandardErrorBackWithWhatWasLeft)
{
    testing::internal::CaptureStderr();
    {
        const ScreenLog log;
        RabitLog::Write(RabitLogLevel::Warning, "left");
    }
    RabitLog::Write(RabitLogLevel::Warning, "after");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "left\nrabit: warning: after\n");
}

}  // namespace
