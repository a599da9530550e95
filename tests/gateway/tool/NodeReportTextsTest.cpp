// The reports of nodes about themselves, as the tool reads them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "AirText.h"
#include "LogText.h"
#include "NodeProblems.h"
#include "RoundTrips.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;

std::vector<std::string> LinesOf(const Gateway::Fleet &fleet)
{
    std::vector<std::string> lines;
    for (const Gateway::Problem &problem : ProblemsOfNodes(fleet))
    {
        lines.push_back(problem.subject + ": " + problem.reason);
    }
    return lines;
}

TEST(NodeProblems, EachIsALineAndTheRestIsCounted)
{
    Gateway::Fleet fleet;
    fleet.nodes.resize(3);
    fleet.nodes[0].node = "uav1";
    fleet.nodes[1].node = "uav2";
    fleet.nodes[1].problems = 3;
    fleet.nodes[1].problem_texts = {"accept Q: there is none", "publish Pose: it is of another type"};
    fleet.nodes[2].node = "uav3";
    fleet.nodes[2].problems = 2;
    EXPECT_THAT(LinesOf(fleet), ElementsAre("node uav2: accept Q: there is none",
                                            "node uav2: publish Pose: it is of another type",
                                            "node uav2: it has 1 more problem; see its log, by `rabit log`",
                                            "node uav3: it has 2 problems; see its log, by `rabit log`"));
}

TEST(NodeProblems, OfOneReasonAreOneRowForPeople)
{
    std::vector<Gateway::Problem> problems;
    for (int i = 1; i <= 40; ++i)
    {
        const std::string node = "uav" + std::to_string(i);
        problems.push_back({"node " + node, node, "no ground"});
        problems.push_back({"node " + node, node, "no ground"});
    }
    problems.push_back({"node uav1", "uav1", "no camera"});
    problems.push_back({"subscribe Pose", "uav2", "no ground"});
    std::vector<std::string> lines;
    for (const Gateway::Problem &problem : Joined(problems))
    {
        lines.push_back(problem.subject + " (" + problem.node + "): " + problem.reason);
    }
    EXPECT_THAT(lines, ElementsAre("nodes uav1 uav2 uav3 uav4 uav5 uav6 and 34 more (): no ground",
                                   "node uav1 (uav1): no camera", "subscribe Pose (uav2): no ground"));
}

TEST(NodeProblems, AreKnownOnceEachLiveNodeHasToldThem)
{
    std::vector<FleetExplorer::Node> nodes(2);
    nodes[0].State = nodes[1].State = Gateway::NodeState::UP;
    nodes[0].AreProblemsKnown = true;
    EXPECT_FALSE(AreProblemsKnown(nodes));
    nodes[1].State = Gateway::NodeState::LOST;
    EXPECT_TRUE(AreProblemsKnown(nodes));
}

TEST(NamesText, ShortensAListThatIsLongerThanALine)
{
    EXPECT_EQ(NamesText({}), "-");
    EXPECT_EQ(NamesText({"a", "b", "c", "d", "e", "f", "g", "h"}), "a b c d e f g h");
    EXPECT_EQ(NamesText({"a", "b", "c", "d", "e", "f", "g", "h", "i"}), "a b c d e f and 3 more");
}

TEST(LogText, IsTheNumberOfItsFirstLineAndPrintableLines)
{
    const auto log = LogTextOf("4294967295\none\ntwo \x1b[2J\nunfinished");
    ASSERT_TRUE(log.has_value());
    EXPECT_EQ(log->First, 4294967295u);
    EXPECT_THAT(log->Lines, ElementsAre("one", "two ?[2J"));
    EXPECT_EQ(log->Next(), 1u) << "numbers wrap around";
}

TEST(LogText, OfAnythingElseIsNone)
{
    for (const char *report : {"", "7", "x\nline\n", "4294967296\nline\n", "7 \nline\n"})
    {
        EXPECT_FALSE(LogTextOf(report).has_value()) << report;
    }
}

TEST(LogText, ALineHasATimeALevelAndAText)
{
    const LogLine line = LogLineOf("2026-11-23T04:04:07.250Z warning a motor is hot");
    EXPECT_EQ(line.Time, "2026-11-23T04:04:07.250Z");
    EXPECT_EQ(line.Level, "warning");
    EXPECT_EQ(line.Text, "a motor is hot");
    EXPECT_EQ(LogLineOf("word").Text, "word");
}

TEST(AirText, IsTenNumbers)
{
    const auto air = AirStatusOf("5000 0 1234 1 2 3 4 5 6 7");
    ASSERT_TRUE(air.has_value());
    EXPECT_EQ(air->budget, 5000.0);
    EXPECT_EQ(air->used, 1234.0);
    EXPECT_EQ(air->bulk, 6.0);
    EXPECT_EQ(air->foreign, 7.0);
    EXPECT_FALSE(AirStatusOf("5000 0 1234 1 2 3 4 5").has_value());
    EXPECT_FALSE(AirStatusOf("").has_value());
    EXPECT_FALSE(AirStatusOf("1 2 3 4 5 6 7 8 nan").has_value());
}

TEST(AirText, AnOlderNodeHasNoClassForeign)
{
    const auto air = AirStatusOf("5000 0 1234 1 2 3 4 5 6");
    ASSERT_TRUE(air.has_value());
    EXPECT_EQ(air->bulk, 6.0);
    EXPECT_EQ(air->foreign, 0.0);
}

TEST(RoundTrips, AreCountedAndRanked)
{
    RoundTrips trips;
    EXPECT_TRUE(std::isnan(trips.Loss()));
    EXPECT_TRUE(std::isnan(trips.Percentile(0.5)));
    for (const double seconds : {3.0, 1.0, 2.0})
    {
        trips.Answered(seconds);
    }
    trips.Lost();
    EXPECT_EQ(trips.Sent(), 4u);
    EXPECT_EQ(trips.Loss(), 0.25);
    EXPECT_EQ(trips.Percentile(0.0), 1.0);
    EXPECT_EQ(trips.Percentile(0.5), 2.0);
    EXPECT_EQ(trips.Percentile(0.99), 3.0);
    EXPECT_EQ(trips.Percentile(1.0), 3.0);
}

}  // namespace
}  // namespace Rabit::Tool
