// When a hang of a manager is worth a line of the log.
#include "HangWatch.h"

#include "CapturedLog.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>

namespace
{

using namespace Rabit;
using namespace RabitTest;
using namespace std::chrono_literals;

class HangWatchTest : public ::testing::Test
{
protected:
    // Returns the number of lines so far.
    std::size_t LinesAfterALook(std::chrono::nanoseconds hangsFor)
    {
        _watch.Look(0, "Vision", false, "ExecuteUnitOfWork", hangsFor, HangWatch::Clock::time_point());
        return _log.Lines().size();
    }

private:
    const CapturedLog _log;
    HangWatch _watch{1, 5s};
};

TEST_F(HangWatchTest, LogsAHangOnceItHasLastedAndEachTimeThatItHasDoubled)
{
    EXPECT_EQ(LinesAfterALook(2s), 0u);
    EXPECT_EQ(LinesAfterALook(5s), 1u);
    EXPECT_EQ(LinesAfterALook(9s), 1u);
    EXPECT_EQ(LinesAfterALook(10s), 2u);
}

TEST_F(HangWatchTest, IsSilentOfAStepThatAStoppedProcessKeptFromEnding)
{
    EXPECT_EQ(LinesAfterALook(0s), 0u);
    EXPECT_EQ(LinesAfterALook(1h), 0u) << "the process was stopped meanwhile";
    EXPECT_EQ(LinesAfterALook(0s), 0u);
    EXPECT_EQ(LinesAfterALook(1h), 0u) << "stopped again";
    EXPECT_EQ(LinesAfterALook(1h + 2s), 1u) << "it hangs all the same";
}

}  // namespace
