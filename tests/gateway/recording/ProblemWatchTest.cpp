#include "recording/ProblemWatch.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

Gateway::Fleet WithProblem(const std::string &subject, const std::string &reason)
{
    Gateway::Fleet fleet;
    fleet.problems.emplace_back();
    fleet.problems.back().subject = subject;
    fleet.problems.back().reason = reason;
    return fleet;
}

TEST(ProblemWatch, TellsAProblemOnceWhileItIsThereAndAgainWhenItComesBack)
{
    ProblemWatch watch;
    EXPECT_EQ(watch.Look(WithProblem("subscribe Pose", "silent for 3 s")), "subscribe Pose: silent for 3 s");
    EXPECT_EQ(watch.Look(WithProblem("subscribe Pose", "silent for 4 s")), "");
    EXPECT_EQ(watch.Look(Gateway::Fleet()), "");
    EXPECT_EQ(watch.Look(WithProblem("subscribe Pose", "silent for 3 s")), "subscribe Pose: silent for 3 s");
}

TEST(ProblemWatch, PassesOverThoseOfTheRecordingItself)
{
    ProblemWatch watch;
    EXPECT_EQ(watch.Look(WithProblem("record", "nothing is recorded")), "");
    EXPECT_EQ(watch.Look(WithProblem("record uav1/Pose", "12 messages were not recorded")), "");
    EXPECT_EQ(watch.Look(WithProblem("recorder", "is another one")), "recorder: is another one");
}

}  // namespace
}  // namespace Rabit
