// The plan follows the rules of docs/how_to/radio.md.
#include "AirPlan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Publishes Pose of type P, subscribes to it of all nodes, and accepts the queue Q.
GatewayConfig NodeOf(const std::string &name)
{
    GatewayConfig config;
    config.Node = name;
    PublishRule pose;
    pose.Message = "Pose";
    pose.Type = "P";
    pose.Qos = QosProfile::Telemetry;
    config.Publish = {pose};
    SubscribeRule wanted;
    wanted.Message = "Pose";
    wanted.Type = "P";
    config.Subscribe = {wanted};
    AcceptRule queue;
    queue.Queue = "Q";
    queue.Types = {"C"};
    config.Accept = {queue};
    return config;
}

AirPlanInput InputOf(double rate, double size)
{
    AirPlanInput input;
    input.Rates.Add("Pose", rate);
    input.Sizes.Add("Pose", size);
    return input;
}

double Of(const AirPlan &plan, const std::string &what)
{
    for (const AirItem &item : plan.Items)
    {
        if (item.What == what)
        {
            return item.BytesPerSecond();
        }
    }
    return -1.0;
}

TEST(AirPlan, ABeatTwiceASecondAndAnAnnouncementEveryTenSecondsIsWhatPresenceCosts)
{
    const std::vector<GatewayConfig> fleet{NodeOf("a")};
    const auto plans = AirPlansOf(fleet, InputOf(0, 0));
    EXPECT_DOUBLE_EQ(Of(plans[0], "beats"), 2.0 * 108.0);
    EXPECT_DOUBLE_EQ(Of(plans[0], "discovery"), 51.0);
}

TEST(AirPlan, WithABudgetBeatsAndAnnouncementsAreRarer)
{
    std::vector<GatewayConfig> fleet{NodeOf("a")};
    fleet[0].Radio.Budget = 2560.0;
    const auto plans = AirPlansOf(fleet, InputOf(0, 0));
    EXPECT_DOUBLE_EQ(Of(plans[0], "beats"), 128.0);
    EXPECT_DOUBLE_EQ(Of(plans[0], "discovery"), 17.0);
}

TEST(AirPlan, AMessageGoesOnceByMulticastHoweverManyReadIt)
{
    std::vector<GatewayConfig> fleet{NodeOf("a"), NodeOf("b"), NodeOf("c")};
    EXPECT_DOUBLE_EQ(Of(AirPlansOf(fleet, InputOf(10, 40))[0], "Pose"), 10.0 * (88.0 + 40.0));
    fleet[0].Multicast = false;
    EXPECT_DOUBLE_EQ(Of(AirPlansOf(fleet, InputOf(10, 40))[0], "Pose"), 2.0 * 10.0 * (88.0 + 40.0));
}

TEST(AirPlan, WhatNobodyReadsDoesNotGo)
{
    std::vector<GatewayConfig> fleet{NodeOf("a"), NodeOf("b")};
    fleet[1].Subscribe.clear();
    const AirPlan plan = AirPlansOf(fleet, AirPlanInput())[0];
    EXPECT_DOUBLE_EQ(Of(plan, "Pose"), 0.0);
    EXPECT_THAT(plan.NotKnown(), IsEmpty());
}

TEST(AirPlan, MaxRateHoldsWhateverIsSaid)
{
    std::vector<GatewayConfig> fleet{NodeOf("a")};
    fleet[0].Publish[0].MaxRate = 5.0;
    EXPECT_DOUBLE_EQ(Of(AirPlansOf(fleet, InputOf(10, 40))[0], "Pose"), 5.0 * 128.0);
    EXPECT_DOUBLE_EQ(Of(AirPlansOf(fleet, InputOf(2, 40))[0], "Pose"), 2.0 * 128.0);
}

TEST(AirPlan, WhatGoesToProgramsThatAreNoNodesCounts)
{
    std::vector<GatewayConfig> fleet{NodeOf("a"), NodeOf("b")};
    ForeignRule written;
    written.Way = ForeignRule::Direction::Publish;
    written.Topic = "rt/setpoint";
    written.Type = "S";
    written.Local = "Setpoint";
    written.MaxRate = 20.0;
    fleet[0].Foreign = {written};
    AirPlanInput input = InputOf(0, 0);
    input.Sizes.Add("S", 40.0);
    EXPECT_DOUBLE_EQ(Of(AirPlansOf(fleet, input)[0], "rt/setpoint"), 20.0 * 128.0);
    fleet[0].Foreign[0].Way = ForeignRule::Direction::Subscribe;
    EXPECT_DOUBLE_EQ(Of(AirPlansOf(fleet, input)[0], "rt/setpoint"), -1.0);
}

TEST(AirPlan, ARateIsStatedForTheLocalNameOfAForeignTopic)
{
    std::vector<GatewayConfig> fleet{NodeOf("a")};
    ForeignRule written;
    written.Way = ForeignRule::Direction::Publish;
    written.Topic = "rt/setpoint";
    written.Type = "S";
    written.Local = "Px4/Setpoint";
    fleet[0].Foreign = {written};
    EXPECT_THAT(AirPlansOf(fleet, InputOf(0, 0))[0].NotKnown(), ElementsAre("rate and size of Px4/Setpoint"));
    for (const char *const name : {"Px4/Setpoint", "a/Px4/Setpoint", "*/Px4/Setpoint"})
    {
        AirPlanInput input = InputOf(0, 0);
        input.Rates.Add(name, 50.0);
        input.Sizes.Add(name, 200.0);
        const auto plans = AirPlansOf(fleet, input);
        EXPECT_DOUBLE_EQ(Of(plans[0], "rt/setpoint"), 50.0 * 288.0) << name;
        EXPECT_TRUE(IsAmong(NamesIn(fleet, false), name)) << name;
    }
    EXPECT_FALSE(IsAmong(NamesIn(fleet, false), "Setpoint"));
    EXPECT_FALSE(IsAmong(NamesIn(fleet, false), "S"));
    EXPECT_TRUE(IsAmong(NamesIn(fleet, true), "S"));
}

TEST(AirPlan, WhatIsNotKnownIsSaid)
{
    const std::vector<GatewayConfig> fleet{NodeOf("a")};
    EXPECT_THAT(AirPlansOf(fleet, AirPlanInput())[0].NotKnown(), ElementsAre("rate and size of Pose"));
    AirPlanInput input;
    input.Rates.Add("a/Pose", 1.0);
    EXPECT_THAT(AirPlansOf(fleet, input)[0].NotKnown(), ElementsAre("size of Pose"));
    input.SizeOfType = [](const std::string &type)
    { return type == "P" ? std::optional<std::size_t>(40) : std::nullopt; };
    EXPECT_THAT(AirPlansOf(fleet, input)[0].NotKnown(), IsEmpty());
    EXPECT_DOUBLE_EQ(Of(AirPlansOf(fleet, input)[0], "Pose"), 128.0);
}

TEST(AirPlan, AQueueMessageCostsTheSenderItAndTheReceiverItsAcknowledgement)
{
    const std::vector<GatewayConfig> fleet{NodeOf("a"), NodeOf("b")};
    AirPlanInput input = InputOf(0, 0);
    input.Rates.Add("a/Q", 2.0);
    input.Sizes.Add("C", 30.0);
    const auto plans = AirPlansOf(fleet, input);
    EXPECT_DOUBLE_EQ(Of(plans[0], "Q of b"), 2.0 * (140.0 + 32.0)) << "in steps of four bytes";
    EXPECT_DOUBLE_EQ(Of(plans[1], "acknowledgements to a"), 2.0 * 140.0);
    EXPECT_DOUBLE_EQ(Of(plans[1], "Q of a"), -1.0);
}

TEST(AirPlan, AQueueWithARuleIsSentToAtARateThatIsNotKnown)
{
    std::vector<GatewayConfig> fleet{NodeOf("a"), NodeOf("b")};
    SendRule rule;
    rule.Queue = "Q";
    fleet[0].Send = {rule};
    EXPECT_THAT(AirPlansOf(fleet, InputOf(0, 0))[0].NotKnown(), ElementsAre("rate and size of Q"));
}

TEST(AirPlan, TheFirstStatementThatFitsHolds)
{
    Stated stated;
    stated.Add("uav1/Pose", 1.0);
    stated.Add("uav*/Pose", 2.0);
    stated.Add("Pose", 3.0);
    EXPECT_EQ(stated.Of("uav1", "Pose"), 1.0);
    EXPECT_EQ(stated.Of("uav2", "Pose"), 2.0);
    EXPECT_EQ(stated.Of("ground", "Pose"), 3.0);
    EXPECT_EQ(stated.Of("ground", "Health"), std::nullopt);
}

TEST(AirPlan, EachPathOfANodeIsPlannedAsIfItCarriedAll)
{
    GatewayConfig two = NodeOf("a");
    two.Paths = {{.Name = "mesh"}, {.Name = "modem"}};
    two.Paths[1].Radio.Budget = 100.0;
    const std::vector<GatewayConfig> fleet = EachPathOf({two, NodeOf("b")});
    ASSERT_EQ(fleet.size(), 3u);
    const auto plans = AirPlansOf(fleet, InputOf(10, 40));
    EXPECT_EQ(plans[0].Path(), "mesh");
    EXPECT_EQ(WhyAboveBudget(plans[0]), "") << "no budget";
    EXPECT_THAT(WhyAboveBudget(plans[1]), HasSubstr("path modem: the budget is 100 B/s, and "));
    EXPECT_EQ(plans[2].Path(), "");
}

TEST(AirPlan, ANodeWithSeveralPathsIsOneReader)
{
    GatewayConfig two = NodeOf("a");
    two.Paths = {{.Name = "mesh"}, {.Name = "modem"}};
    GatewayConfig alone = NodeOf("b");
    alone.Multicast = false;
    const std::vector<GatewayConfig> fleet = EachPathOf({two, alone});
    const std::vector<GatewayConfig> plain{NodeOf("a"), alone};
    EXPECT_EQ(Of(AirPlansOf(fleet, InputOf(10, 40))[2], "Pose"),
              Of(AirPlansOf(plain, InputOf(10, 40))[1], "Pose"));
}

TEST(AirPlan, WhatExceedsTheBudgetIsToldWithWhatTakesMost)
{
    std::vector<GatewayConfig> fleet{NodeOf("a")};
    fleet[0].Radio.Budget = 1000.0;
    EXPECT_EQ(WhyAboveBudget(AirPlansOf(fleet, InputOf(5, 40))[0]), "");
    EXPECT_THAT(
        WhyAboveBudget(AirPlansOf(fleet, InputOf(10, 40))[0]),
        HasSubstr("the budget is 1000 B/s, and 1351 B/s would go on the air, most of it Pose with 1280 B/s"));
}

TEST(AirPlan, NamesWhatTakesMoreThanASecondOfTheBudgetEachTime)
{
    std::vector<GatewayConfig> fleet{NodeOf("a")};
    EXPECT_THAT(LargerThanASecond(AirPlansOf(fleet, InputOf(0.1, 20'000))[0]), IsEmpty()) << "no budget";
    fleet[0].Radio.Budget = 5000.0;
    EXPECT_THAT(LargerThanASecond(AirPlansOf(fleet, InputOf(0.1, 4000))[0]), IsEmpty());
    EXPECT_THAT(LargerThanASecond(AirPlansOf(fleet, InputOf(0.1, 20'000))[0]),
                ElementsAre(HasSubstr("one Pose takes 21")));
}

}  // namespace
}  // namespace Rabit::Tool
