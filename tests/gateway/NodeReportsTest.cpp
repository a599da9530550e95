// The reports of nodes about themselves, requested by others: whole nodes on the simulated network.
#include <gmock/gmock.h>
#include <rabit/RabitLog.h>
#include <rabit/gateway/Claims.h>
#include <rabit/gateway/FleetExplorer.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../core/CapturedLog.h"
#include "HandNode.h"
#include "SimulatedFleet.h"
#include "types/TypeQuestions.h"
#include "wire/BeatExtensions.h"
#include "wire/ForeignReport.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Report = FleetExplorer::Report;

class NodeReportsTest : public ::testing::Test
{
protected:
    // An aircraft that subscribes to a message that nobody publishes, if it has a problem.
    SimulatedNode &AddAircraft(bool hasProblem)
    {
        GatewayConfig config;
        config.Node = "uav1";
        if (hasProblem)
        {
            config.Subscribe.push_back({.Message = "Pse", .Type = "Uav::Pose"});
        }
        return fleet.Add(config);
    }

    SimulatedNode &AddGround(const std::vector<std::string> &problemsOf)
    {
        GatewayConfig config;
        config.Node = "ground";
        config.ProblemsOf = problemsOf;
        return fleet.Add(config);
    }

    FleetExplorer &AddTool()
    {
        GatewayConfig config;
        config.Node = "tool";
        config.Tool.emplace();
        return fleet.Add(config).Manager->Explorer();
    }

    static Gateway::NodeStatus RowOfUav(SimulatedNode &node)
    {
        for (const Gateway::NodeStatus &status : node.Fleet().nodes)
        {
            if (status.node == "uav1")
            {
                return status;
            }
        }
        ADD_FAILURE() << "no row of uav1";
        return {};
    }

    // Waits for the answer.
    std::optional<FleetExplorer::Answer> Ask(FleetExplorer &explorer, Report what, std::uint32_t argument = 0,
                                             std::chrono::nanoseconds limit = 5s)
    {
        explorer.AskForReport("uav1", what, argument);
        std::optional<FleetExplorer::Answer> answer;
        fleet.RunUntil([&] { return (answer = explorer.TakeReport("uav1", what)).has_value(); }, limit);
        return answer;
    }

    RabitTest::CapturedLog log;
    SimulatedFleet fleet{1};
};

TEST_F(NodeReportsTest, TheProblemsOfANodeReachThoseWhoAskForThem)
{
    AddAircraft(true);
    SimulatedNode &ground = AddGround({"uav*"});
    fleet.RunFor(6s);
    EXPECT_EQ(RowOfUav(ground).problems, 1u);
    EXPECT_THAT(RowOfUav(ground).problem_texts,
                ElementsAre(::testing::StartsWith("subscribe Pse: ground does not publish `Pse`")));
}

TEST_F(NodeReportsTest, WhoDoesNotAskForTheProblemsOfANodeKnowsTheirNumber)
{
    AddAircraft(true);
    SimulatedNode &ground = AddGround({"uav9"});
    fleet.RunFor(6s);
    EXPECT_EQ(RowOfUav(ground).problems, 1u);
    EXPECT_THAT(RowOfUav(ground).problem_texts, IsEmpty());
}

TEST_F(NodeReportsTest, AProblemThatIsGoneIsGoneElsewhere)
{
    AddAircraft(true);
    SimulatedNode &ground = AddGround({"*"});
    fleet.RunFor(6s);
    GatewayConfig publisher;
    publisher.Node = "uav2";
    publisher.Publish.push_back({.Message = "Pse", .Type = "Uav::Pose"});
    const auto pose = fleet.Add(publisher).Register<Uav::Pose>("Pse");
    pose->PostMessage();
    fleet.RunFor(6s);
    EXPECT_EQ(RowOfUav(ground).problems, 0u);
    EXPECT_THAT(RowOfUav(ground).problem_texts, IsEmpty());
}

TEST_F(NodeReportsTest, TheProblemsOfANodeReachThroughHeavyLoss)
{
    SimulatedFaults faults;
    faults.Loss = 0.4;
    fleet.Network.SetFaults("*", "*", faults);
    AddAircraft(true);
    SimulatedNode &ground = AddGround({"uav*"});
    EXPECT_TRUE(fleet.RunUntil(
        [&] { return !ground.Fleet().nodes.empty() && !RowOfUav(ground).problem_texts.empty(); }, 60s));
}

TEST_F(NodeReportsTest, NodesThatAreGoneBeforeTheirReportsCameDoNotKeepThoseOfOthersAway)
{
    SimulatedNode &ground = AddGround({"*"});
    fleet.RunFor(1s);
    std::vector<std::unique_ptr<HandNode>> mute;
    for (std::size_t i = 0; i < TypeQuestions::MostWanted; ++i)
    {
        mute.push_back(std::make_unique<HandNode>(fleet.Network, "mute" + std::to_string(i), 1));
    }
    for (int beat = 0; beat < 5; ++beat)
    {
        for (const auto &node : mute)
        {
            Gateway::Beat told = node->Beat();
            BeatExtensions::Say(told, ProblemCount{.Count = 1, .Digest = 7});
            node->Write(told);
        }
        fleet.RunFor(500ms);
    }
    fleet.RunFor(60s);
    AddAircraft(true);
    fleet.RunFor(10s);
    EXPECT_EQ(RowOfUav(ground).problem_texts.size(), 1u);
}

TEST_F(NodeReportsTest, MoreNodesThanAreAskedAtOnceAllAnswer)
{
    std::vector<std::string> names;
    for (std::size_t i = 0; i < TypeQuestions::MostWanted + 4; ++i)
    {
        GatewayConfig config;
        config.Node = names.emplace_back("n" + std::to_string(i));
        fleet.Add(config);
    }
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(3s);
    for (const std::string &name : names)
    {
        explorer.AskForReport(name, Report::Air);
    }
    fleet.RunFor(10s);
    for (const std::string &name : names)
    {
        EXPECT_TRUE(explorer.TakeReport(name, Report::Air).has_value()) << name;
    }
}

TEST_F(NodeReportsTest, TheForeignTopicsOfANodeAreToldWithTheirStates)
{
    GatewayConfig config;
    config.Node = "lab";
    config.Foreign.push_back({.Topic = "rt/pose", .Type = "Uav::Pose", .Local = "Lab/Pose"});
    fleet.Add(config);
    AddAircraft(false);
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(3s);
    explorer.AskForReport("lab", Report::Foreign);
    explorer.AskForReport("uav1", Report::Foreign);
    fleet.RunFor(3s);
    const auto told = explorer.TakeReport("lab", Report::Foreign);
    ASSERT_TRUE(told.has_value());
    const auto topics = ForeignReport::TopicsIn(told->Text);
    ASSERT_EQ(topics.size(), 1u);
    EXPECT_EQ(topics[0].topic, "rt/pose");
    EXPECT_EQ(topics[0].local, "Lab/Pose");
    EXPECT_EQ(topics[0].state, Gateway::NodeState::LOST);
    EXPECT_THAT(topics[0].reason, HasSubstr("no program writes `rt/pose`"));
    const auto nothing = explorer.TakeReport("uav1", Report::Foreign);
    ASSERT_TRUE(nothing.has_value()) << "it has none, and says so";
    EXPECT_TRUE(ForeignReport::TopicsIn(nothing->Text).empty());
}

TEST_F(NodeReportsTest, ANodeTellsTheMembersOfItsAgreementAndTheClaimsThatItHolds)
{
    GatewayConfig config;
    config.Node = "uav1";
    config.Agreement.emplace().Members = {"uav1"};
    std::optional<Claims> claims;
    fleet.Add(config, [&claims](SimulatedNode & /*node*/, GatewayConfig &completed)
              { claims.emplace(completed).Claim("cell 17"); });
    FleetExplorer &explorer = AddTool();
    ASSERT_TRUE(fleet.RunUntil([&] { return claims->StillMine("cell 17"); }, 10s));
    const auto held = Ask(explorer, Report::Agreement);
    ASSERT_TRUE(held.has_value());
    EXPECT_EQ(held->Text,
              "members\t2000\tuav1\nclaim\t" + std::to_string(*claims->FenceOf("cell 17")) + "\tcell 17\n");
    claims->Release("cell 17");
    fleet.RunFor(3s);  // answers to repetitions of the first request have come
    EXPECT_EQ(Ask(explorer, Report::Agreement)->Text, "members\t2000\tuav1\n");
}

TEST_F(NodeReportsTest, AMemberWhoseProgramHasNoClaimsTellsTheMembersNevertheless)
{
    GatewayConfig config;
    config.Node = "uav1";
    config.Agreement.emplace().Members = {"uav1", "uav2"};
    fleet.Add(config);
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(2s);
    const auto told = Ask(explorer, Report::Agreement);
    ASSERT_TRUE(told.has_value());
    EXPECT_EQ(told->Text, "members\t2000\tuav1\tuav2\n");
}

TEST_F(NodeReportsTest, ANodeWithoutAnAgreementSaysSo)
{
    AddAircraft(false);
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(2s);
    const auto told = Ask(explorer, Report::Agreement);
    ASSERT_TRUE(told.has_value());
    EXPECT_EQ(told->Text, "");
}

TEST_F(NodeReportsTest, ANodeThatHasNoLinesYetAnswersWhenThereIsOne)
{
    AddAircraft(false);
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(2s);
    const auto last = Ask(explorer, Report::LastLines, 1);
    ASSERT_TRUE(last.has_value());
    const std::uint32_t next = static_cast<std::uint32_t>(std::stoul(last->Text)) + 1;
    EXPECT_FALSE(Ask(explorer, Report::LinesFrom, next).has_value());
    RabitLog::Write(RabitLogLevel::Warning, "a motor is hot");
    std::optional<FleetExplorer::Answer> answer;
    fleet.RunUntil([&] { return (answer = explorer.TakeReport("uav1", Report::LinesFrom)).has_value(); }, 3s);
    ASSERT_TRUE(answer.has_value());
    EXPECT_THAT(answer->Text, HasSubstr(" warning a motor is hot\n"));
}

TEST_F(NodeReportsTest, ANodeWhoseReportsAreOffTellsItsFiguresAndNoWords)
{
    GatewayConfig config;
    config.Node = "uav1";
    config.Reports = false;
    config.Subscribe.push_back({.Message = "Pse", .Type = "Uav::Pose"});
    fleet.Add(config);
    SimulatedNode &ground = AddGround({"*"});
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(6s);
    EXPECT_EQ(RowOfUav(ground).problems, 1u);
    EXPECT_THAT(RowOfUav(ground).problem_texts, IsEmpty());
    EXPECT_FALSE(Ask(explorer, Report::LastLines, 20).has_value());
    EXPECT_FALSE(Ask(explorer, Report::LinesFrom, 0).has_value());
    EXPECT_FALSE(Ask(explorer, Report::Foreign).has_value());
    EXPECT_FALSE(Ask(explorer, Report::Agreement).has_value());
    EXPECT_TRUE(Ask(explorer, Report::Air).has_value());
    EXPECT_TRUE(Ask(explorer, Report::Echo, 1).has_value());
}

TEST_F(NodeReportsTest, TellsItsShareOfTheChannel)
{
    AddAircraft(false);
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(2s);
    const auto air = Ask(explorer, Report::Air);
    ASSERT_TRUE(air.has_value());
    EXPECT_THAT(air->Text, ::testing::MatchesRegex("([0-9]+ ){9}[0-9]+"));
}

TEST_F(NodeReportsTest, AnEchoTakesTheRoundTrip)
{
    SimulatedFaults faults;
    faults.Delay = 30ms;
    fleet.Network.SetFaults("*", "*", faults);
    AddAircraft(false);
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(3s);
    // The first answer of a node is lost: its writer is new, and not matched.
    ASSERT_TRUE(Ask(explorer, Report::Air).has_value());
    const auto echo = Ask(explorer, Report::Echo, 1);
    ASSERT_TRUE(echo.has_value());
    EXPECT_GE(echo->Took, 60ms);
    EXPECT_LT(echo->Took, 90ms);
}

}  // namespace
}  // namespace Rabit
