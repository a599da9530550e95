#include "mirrors/RepeatPace.h"

#include <gtest/gtest.h>

#include <vector>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

TEST(RepeatPace, NothingIsRepeatedThatNobodyAskedForOrThatWasNeverWritten)
{
    RepeatPace pace;
    EXPECT_FALSE(pace.Due());
    pace.Ask(1s);
    EXPECT_FALSE(pace.Due());
    pace.Written(true, 2s);
    EXPECT_FALSE(pace.Due());
}

TEST(RepeatPace, TheFirstWhoAsksIsAnsweredAtOnce)
{
    RepeatPace pace;
    pace.Written(true, 1s);
    pace.Ask(10s);
    ASSERT_TRUE(pace.Due());
    EXPECT_LE(*pace.Due(), 10s);
    pace.Written(false, 10s);
    EXPECT_FALSE(pace.Due());
}

TEST(RepeatPace, WhoAsksBeforeTheLastOneCouldComeIsNotAnswered)
{
    RepeatPace pace;
    pace.Written(true, 1s);
    pace.Ask(1s + RepeatPace::ShortestGap - 1ns);
    EXPECT_FALSE(pace.Due());
    pace.Ask(1s + RepeatPace::ShortestGap);
    EXPECT_EQ(pace.Due(), 1s + RepeatPace::ShortestGap);
}

// Returns the gaps between the writes of one value that is requested all the time.
std::vector<Ns> Gaps(RepeatPace &pace, Ns written, std::size_t count)
{
    std::vector<Ns> gaps;
    Ns last = written;
    for (Ns now = written; gaps.size() < count; now += 10ms)
    {
        pace.Ask(now);
        if (pace.Due() && *pace.Due() <= now)
        {
            gaps.push_back(now - last);
            last = now;
            pace.Written(false, now);
        }
    }
    return gaps;
}

TEST(RepeatPace, EachTimeWaitsTwiceAsLongAsTheOneBefore)
{
    RepeatPace pace;
    pace.Written(true, 1s);
    EXPECT_EQ(Gaps(pace, 1s, 8), (std::vector<Ns>{50ms, 100ms, 200ms, 400ms, 800ms, 1600ms, 2s, 2s}));
}

TEST(RepeatPace, ANewValueBeginsAnew)
{
    RepeatPace pace;
    pace.Written(true, 1s);
    Gaps(pace, 1s, 8);
    pace.Written(true, 60s);
    EXPECT_EQ(Gaps(pace, 60s, 2), (std::vector<Ns>{50ms, 100ms}));
}

TEST(RepeatPace, SoDoesWhoAsksAfterSomeQuiet)
{
    RepeatPace pace;
    pace.Written(true, 1s);
    Gaps(pace, 1s, 8);
    pace.Written(false, 60s);
    pace.Ask(60s + RepeatPace::Quiet);
    EXPECT_EQ(pace.Due(), 60s + RepeatPace::ShortestGap);
}

}  // namespace
}  // namespace Rabit
