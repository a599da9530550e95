// Which handlers are named as slow, and for how long.
#include "report/HandlerWatch.h"

#include <gtest/gtest.h>
#include <rabit/ManualClock.h>

#include <chrono>
#include <string>
#include <vector>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

class HandlerWatchTest : public testing::Test
{
protected:
    void Call(const std::string &subject, std::chrono::nanoseconds takes)
    {
        watch.Begins(subject);
        clock.Advance(takes);
        watch.Returned();
    }

    std::vector<std::string> Rows() const
    {
        std::vector<std::string> rows;
        for (const Gateway::Problem &problem : watch.Problems(clock.Monotonic()))
        {
            rows.push_back(problem.subject + ": " + problem.reason);
        }
        return rows;
    }

    ManualClock clock{1.4e9, 100s};
    HandlerWatch watch{clock};
};

using Lines = std::vector<std::string>;

TEST_F(HandlerWatchTest, AQuickHandlerIsNoProblem)
{
    Call("ground/Pose", 999ms);
    EXPECT_EQ(Rows(), Lines());
}

TEST_F(HandlerWatchTest, ASlowOneIsNamedForSomeTimeAfterItsReturn)
{
    Call("ground/Pose", 2500ms);
    const Lines row{"handler of ground/Pose: it took 2.5 s; the handlers of other messages waited for it"};
    EXPECT_EQ(Rows(), row);
    clock.Advance(HandlerWatch::Memory - 1ns);
    EXPECT_EQ(Rows(), row);
    clock.Advance(1ns);
    EXPECT_EQ(Rows(), Lines());
}

TEST_F(HandlerWatchTest, AQuickCallDoesNotTakeTheRowOfASlowOne)
{
    Call("ground/Pose", 2500ms);
    Call("ground/Pose", 1ms);
    EXPECT_EQ(Rows().size(), 1u);
}

TEST_F(HandlerWatchTest, OneThatHasNotReturnedIsNamedInAFewWords)
{
    watch.Begins("ground/Pose");
    clock.Advance(999ms);
    EXPECT_EQ(Rows(), Lines());
    const auto row = [](const std::string &time)
    {
        return Lines{"handler of ground/Pose: it has not returned for more than " + time +
                     "; the handlers of other messages wait for it"};
    };
    clock.Advance(1ms);
    EXPECT_EQ(Rows(), row("1.0 s"));
    clock.Advance(8s);
    EXPECT_EQ(Rows(), row("1.0 s"));
    clock.Advance(1s);
    EXPECT_EQ(Rows(), row("10.0 s"));
    clock.Advance(24h);
    EXPECT_EQ(Rows(), row("3600.0 s"));
}

TEST_F(HandlerWatchTest, AHandlerHasOneRowAlsoWhenItIsCalledAgain)
{
    Call("ground/Pose", 2500ms);
    watch.Begins("ground/Pose");
    clock.Advance(2s);
    ASSERT_EQ(Rows().size(), 1u);
    EXPECT_NE(Rows().front().find("has not returned"), std::string::npos);
}

TEST_F(HandlerWatchTest, OfManySlowOnesTheNewestHaveRows)
{
    for (int i = 0; i < 100; ++i)
    {
        Call("uav" + std::to_string(i) + "/Pose", HandlerWatch::Slow);
    }
    ASSERT_EQ(Rows().size(), 10u) << "those of the last 10 s";
    EXPECT_NE(Rows().front().find("handler of uav90/Pose: "), std::string::npos);
}

}  // namespace
}  // namespace Rabit
