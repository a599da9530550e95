#include "doctor/NodeChecks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace Rabit::Tool::Doctor
{
namespace
{

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

FleetSession::Node NodeOf(const std::string &name, double clockAhead = 0.0)
{
    FleetSession::Node node;
    node.Name = name;
    node.State = Gateway::NodeState::UP;
    node.Offers.emplace();
    node.ClockAhead = clockAhead;
    return node;
}

std::vector<std::string> ProblemLinesOf(const std::vector<Finding> &findings)
{
    std::vector<std::string> lines;
    for (const Finding &finding : findings)
    {
        if (finding.How == Level::Problem)
        {
            EXPECT_NE(finding.Advice, "") << finding.Text;
            lines.push_back(finding.Subject + ": " + finding.Text);
        }
    }
    return lines;
}

TEST(NodeChecks, TwoNodesOfOneNameAreTold)
{
    auto node = NodeOf("uav1");
    EXPECT_THAT(ProblemLinesOf(OfNodes({node}, {})), IsEmpty());
    node.IsTwice = true;
    EXPECT_THAT(ProblemLinesOf(OfNodes({node}, {})), ElementsAre("node uav1: two live nodes have this name"));
}

Gateway::Fleet FleetOverTwoPaths(Gateway::NodeState onModem)
{
    Gateway::Fleet fleet;
    fleet.paths.resize(2);
    fleet.paths[0].path = "mesh";
    fleet.paths[1].path = "modem";
    Gateway::NodeStatus &node = fleet.nodes.emplace_back();
    node.node = "uav1";
    for (const Gateway::PathStatus &path : fleet.paths)
    {
        Gateway::PathToNode &row = node.paths.emplace_back();
        row.path = path.path;
        row.state = path.path == "modem" ? onModem : Gateway::NodeState::UP;
    }
    return fleet;
}

TEST(NodeChecks, APathOnWhichNobodyIsHeardIsTold)
{
    EXPECT_THAT(ProblemLinesOf(OfPaths(FleetOverTwoPaths(Gateway::NodeState::UP), 6.0)), IsEmpty());
    EXPECT_THAT(ProblemLinesOf(OfPaths(FleetOverTwoPaths(Gateway::NodeState::LOST), 6.0)),
                ElementsAre("path modem: nobody was heard on it for 6.0 s, and others by other paths"));
}

TEST(NodeChecks, APathIsToldOnceIfTheGatewayTellsIt)
{
    Gateway::Fleet fleet = FleetOverTwoPaths(Gateway::NodeState::LOST);
    fleet.problems.emplace_back().subject = "path modem";
    EXPECT_THAT(ProblemLinesOf(OfPaths(fleet, 12.0)), IsEmpty());
}

TEST(NodeChecks, IfNobodyIsHeardAtAllNoPathIsToldForItself)
{
    Gateway::Fleet fleet = FleetOverTwoPaths(Gateway::NodeState::LOST);
    fleet.nodes.clear();
    EXPECT_THAT(ProblemLinesOf(OfPaths(fleet, 6.0)), IsEmpty());
}

TEST(NodeChecks, LinksThatDoNotGetOnAreToldByWhatTheNodesSay)
{
    using Kind = FleetExplorer::Strain::Kind;
    auto node = NodeOf("uav1");
    node.Strains = {{.What = Kind::Filling, .Other = "uav2", .Percent = 100, .Messages = 7},
                    {.What = Kind::InDoubt, .Other = "", .Percent = 0, .Messages = 65535},
                    {.What = Kind::HeldBack, .Other = "ground", .Percent = 0, .Messages = 0}};
    EXPECT_THAT(
        ProblemLinesOf(OfLinks({node}, {})),
        ElementsAre("outbox of uav1: that for uav2 is 100 % full, and of late it refused 7",
                    "messages of uav1: 65535 or more to a node that is not heard here in doubt: it restarted "
                    "before it acknowledged",
                    "queue of uav1: it is full, and messages of ground wait"));
}

TEST(NodeChecks, FullQueuesAreNamedTheLongestFirstAndThreeAtMost)
{
    auto node = NodeOf("uav1");
    node.Strains = {{.What = FleetExplorer::Strain::Kind::HeldBack, .Other = "ground"}};
    Gateway::Fleet fleet;
    Gateway::NodeStatus &status = fleet.nodes.emplace_back();
    status.node = "uav1";
    const auto add = [&status](const std::string &queue, const std::string &length, const std::string &of)
    {
        status.problem_texts.push_back("queue " + queue + ": it is full (" + length +
                                       " messages), and its manager takes no messages from it, or too few: "
                                       "those of `" +
                                       of + "` wait");
    };
    add("Camera", "20", "uav2");
    add("Commands", "100", "ground");
    EXPECT_THAT(ProblemLinesOf(OfLinks({node}, fleet)),
                ElementsAre("queue of uav1: `Commands` is full, and messages of ground wait"));
    add("Lines", "7", "ground");
    add("Poses", "1000", "ground");
    add("Video", "30", "ground");
    add("Words", "8", "ground");
    EXPECT_THAT(ProblemLinesOf(OfLinks({node}, fleet)),
                ElementsAre("queues of uav1: `Poses`, `Commands`, `Video` and 2 more are full, and messages "
                            "of ground wait"));
}

TEST(NodeChecks, AnOutboxThatFillsAndHasRefusedNothingIsWorthANote)
{
    auto node = NodeOf("uav1");
    node.Strains = {{.What = FleetExplorer::Strain::Kind::Filling, .Other = "uav2", .Percent = 60}};
    const std::vector<Finding> findings = OfLinks({node}, {});
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings.front().How, Level::Note);
    EXPECT_EQ(findings.front().Text, "that for uav2 is 60 % full");
}

TEST(NodeChecks, LinksAreGoodWhereNobodySaysOtherwiseAndOfWhoIsLostNothingIsSaid)
{
    auto node = NodeOf("uav1");
    ASSERT_THAT(OfLinks({node}, {}), SizeIs(1));
    EXPECT_EQ(OfLinks({node}, {}).front().How, Level::Good);
    node.Strains.emplace_back();
    node.State = Gateway::NodeState::LOST;
    EXPECT_THAT(OfLinks({node}, {}), IsEmpty());
}

TEST(NodeChecks, ANodeWhoseAnnouncementDoesNotComeIsTold)
{
    auto node = NodeOf("uav1");
    node.Offers.reset();
    EXPECT_THAT(ProblemLinesOf(OfNodes({node}, {})), SizeIs(1));
    node.State = Gateway::NodeState::LOST;
    EXPECT_THAT(ProblemLinesOf(OfNodes({node}, {})), IsEmpty());
}

TEST(NodeChecks, WhatTheGatewayLacksIsTold)
{
    Gateway::Fleet fleet;
    fleet.problems.emplace_back();
    fleet.problems[0].subject = "uav1";
    fleet.problems[0].reason = "its gateway speaks another version of presence";
    fleet.malformed = 3;
    EXPECT_THAT(ProblemLinesOf(OfNodes({}, fleet)),
                ElementsAre("uav1: its gateway speaks another version of presence",
                            "gateways: 3 samples made no sense"));
}

TEST(NodeChecks, AClockThatDiffersByMoreThanTheWayExplainsIsTold)
{
    EXPECT_THAT(ProblemLinesOf(OfClocks({NodeOf("uav1", 0.4), NodeOf("uav2", -0.4)}, {})), IsEmpty());
    EXPECT_THAT(ProblemLinesOf(OfClocks({NodeOf("uav1", 0.0), NodeOf("uav2", -37.0)}, {})),
                ElementsAre(HasSubstr("clock of uav2: 37.0 s behind this machine's")));
    Gateway::Fleet slow;
    slow.nodes.emplace_back();
    slow.nodes[0].node = "uav1";
    slow.nodes[0].round_trip_s = 5.0;
    EXPECT_THAT(ProblemLinesOf(OfClocks({NodeOf("uav1", 3.0)}, slow)), IsEmpty());
}

TEST(NodeChecks, WhereAllOthersAgreeThisMachinesClockIsWrong)
{
    EXPECT_THAT(ProblemLinesOf(OfClocks({NodeOf("uav1", 60.1), NodeOf("uav2", 60.2)}, {})),
                ElementsAre("clock of this machine: 60.2 s behind those of all 2 nodes"));
}

TEST(NodeChecks, ManyBeatsThatDidNotComeAreAProblemAndFewAreNot)
{
    auto node = NodeOf("uav1");
    node.BeatsHeard = 20;
    EXPECT_EQ(OfLosses({node}).front().How, Level::Good);
    node.BeatsMissed = 1;
    EXPECT_EQ(OfLosses({node}).front().How, Level::Note);
    node.BeatsMissed = 5;
    EXPECT_THAT(ProblemLinesOf(OfLosses({node})), ElementsAre("loss from uav1: 5 of 25 beats did not come"));
}

}  // namespace
}  // namespace Rabit::Tool::Doctor
