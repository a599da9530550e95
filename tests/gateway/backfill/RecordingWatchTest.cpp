#include "backfill/RecordingWatch.h"

#include <gtest/gtest.h>

namespace Rabit::Backfill
{
namespace
{

using namespace std::chrono_literals;
using State = RecordingWatch::State;

RecordingStatus Failing(const std::string &problem, std::uint64_t notKept)
{
    RecordingStatus status;
    status.Problem = problem;
    status.NotKept = notKept;
    return status;
}

TEST(RecordingWatchTest, WithoutAFailureItWorks)
{
    RecordingWatch watch;
    EXPECT_EQ(watch.Look({}, 0s), State::Works);
}

TEST(RecordingWatchTest, AfterAFailureAllIsOnTheDiskLater)
{
    RecordingWatch watch;
    EXPECT_EQ(watch.Look(Failing("full", 0), 0s), State::Fails);
    EXPECT_EQ(watch.Look({}, 100ms), State::Fails);
    EXPECT_EQ(watch.Look({}, RecordingWatch::AllIsOnDisk), State::WorksAgain);
    EXPECT_EQ(watch.Look({}, 1h), State::Works);
}

TEST(RecordingWatchTest, AFailureThatIsOverIsNoticed)
{
    RecordingWatch watch;
    EXPECT_EQ(watch.Look({}, 0s), State::Works);
    EXPECT_EQ(watch.Look(Failing("", 3), 10s), State::Fails);
    EXPECT_EQ(watch.Look(Failing("", 3), 20s), State::WorksAgain);
}

TEST(RecordingWatchTest, AnotherFailureProlongsThePause)
{
    RecordingWatch watch;
    watch.Look(Failing("", 1), 0s);
    EXPECT_EQ(watch.Look(Failing("", 2), 1900ms), State::Fails);
    EXPECT_EQ(watch.Look(Failing("", 2), 2100ms), State::Fails);
}

}  // namespace
}  // namespace Rabit::Backfill
