#include "ProblemLines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace
{
using Ground::ProblemLogLine;
using Ground::ProblemTableLines;
using Rabit::Gateway::Problem;
using testing::ElementsAre;
using testing::IsEmpty;

Problem Of(const std::string &subject, const std::string &node, const std::string &reason)
{
    Problem problem;
    problem.subject = subject;
    problem.node = node;
    problem.reason = reason;
    return problem;
}

std::vector<std::string> Texts(const std::vector<Ground::TableLine> &lines)
{
    std::vector<std::string> texts;
    for (const auto &line : lines)
        texts.push_back(line.Text);
    return texts;
}

const std::vector<Problem> Two = {Of("subscribe Pse", "uav1", "uav1 does not publish `Pse`"),
                                  Of("send uav9/Q", "uav9", "no node `uav9` has announced itself")};

TEST(ProblemLines, OwnProblemsOfOtherNodesAreARowForEach)
{
    Rabit::Gateway::Fleet fleet;
    fleet.problems = {Two[0]};
    fleet.nodes.resize(3);
    fleet.nodes[0].node = "uav1";
    fleet.nodes[1].node = "uav2";
    fleet.nodes[1].problems = 2;
    fleet.nodes[1].problem_texts = {"publish Pose: it is of another type", "accept Q: there is none"};
    fleet.nodes[2].node = "uav3";
    fleet.nodes[2].problems = 1;
    EXPECT_THAT(
        Texts(ProblemTableLines(Ground::AllProblems(fleet), 0)),
        ElementsAre("3 problems:", "  subscribe Pse, uav1: uav1 does not publish `Pse`",
                    "  uav2: 2 problems: publish Pose: it is of another type; accept Q: there is none",
                    "  uav3: 1 problem: see its log"));
}

TEST(ProblemLines, AreNoneWhereNothingIsWrong)
{
    EXPECT_THAT(ProblemTableLines({}, 0), IsEmpty());
    EXPECT_EQ(ProblemLogLine({}, 0, 12), "");
}

TEST(ProblemLines, NameSubjectNodeAndReason)
{
    const auto lines = ProblemTableLines(Two, 0.5);
    EXPECT_THAT(Texts(lines), ElementsAre("2 problems:", "  subscribe Pse, uav1: uav1 does not publish `Pse`",
                                          "  send uav9/Q: no node `uav9` has announced itself"));
    EXPECT_EQ(lines[0].Shown, Ground::Emphasis::Warning);
    EXPECT_EQ(ProblemLogLine(Two, 0.5, 12.4), "   12.4 s  2 problems: subscribe Pse (uav1), send uav9/Q");
}

TEST(ProblemLines, CountWhatIsBeyondTheFirstFew)
{
    std::vector<Problem> problems;
    for (int i = 1; i <= 7; ++i)
        problems.push_back(Of("subscribe M" + std::to_string(i), "", "no node"));
    const auto lines = Texts(ProblemTableLines(problems, 0));
    ASSERT_EQ(lines.size(), Ground::ProblemsOnScreen + 2);
    EXPECT_EQ(lines[0], "7 problems:");
    EXPECT_EQ(lines.back(), "  and 2 more");
    EXPECT_EQ(ProblemLogLine(problems, 0, 0),
              "    0.0 s  7 problems: subscribe M1, subscribe M2, subscribe M3, subscribe M4, subscribe M5 "
              "and 2 more");
}

TEST(ProblemLines, SayHowOldTheyAreIfTheGatewayHasStopped)
{
    EXPECT_EQ(ProblemTableLines({Two[0]}, 61)[0].Text, "1 problem (61 s ago):");
}

TEST(ProblemLines, NeverPrintControlCharactersFromTheNetwork)
{
    const std::vector<Problem> bad = {Of("a\x1b[2J", "b\n", "c\xff")};
    EXPECT_EQ(ProblemTableLines(bad, 0)[1].Text, "  a?[2J, b?: c?");
    EXPECT_EQ(ProblemLogLine(bad, 0, 0), "    0.0 s  1 problem: a?[2J (b?)");
}

}  // namespace
