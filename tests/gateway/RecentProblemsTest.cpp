#include "presence/RecentProblems.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

Gateway::Problem ProblemOf(const std::string &node, const std::string &reason = "why")
{
    Gateway::Problem problem;
    problem.subject = "accept Orders";
    problem.node = node;
    problem.reason = reason;
    return problem;
}

TEST(RecentProblems, ReportsAProblemForSomeSecondsAfterItsLastSign)
{
    RecentProblems problems;
    problems.Note(ProblemOf("uav1"), 1s);
    problems.Note(ProblemOf("uav1", "another"), 3s);
    EXPECT_EQ(problems.Problems(2s + RecentProblems::Memory),
              std::vector<Gateway::Problem>{ProblemOf("uav1", "another")});
    EXPECT_TRUE(problems.Problems(3s + RecentProblems::Memory).empty());
}

TEST(RecentProblems, RemembersABoundedNumber)
{
    RecentProblems problems;
    for (int i = 0; i < 1000; ++i)
    {
        problems.Note(ProblemOf(std::string("n").append(std::to_string(i))), 1s);
    }
    EXPECT_EQ(problems.Problems(1s).size(), RecentProblems::MostRemembered);
    problems.Note(ProblemOf("late"), 1s + RecentProblems::Memory);
    EXPECT_EQ(problems.Problems(1s + RecentProblems::Memory),
              std::vector<Gateway::Problem>{ProblemOf("late")});
}

}  // namespace
}  // namespace Rabit
