#include "FleetCheck.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

GatewayConfig NodeOf(const std::string &name)
{
    GatewayConfig config;
    config.Node = name;
    config.File = name + ".yaml";
    config.Lines = {{"node", 1}, {"domain", 2}, {"transport", 3}, {"multicast", 4}};
    return config;
}

PublishRule Publishes(const std::string &message, const std::string &type = "T")
{
    PublishRule rule;
    rule.Message = message;
    rule.Type = type;
    rule.Line = 10;
    return rule;
}

SubscribeRule Wants(const std::string &message, const std::vector<std::string> &from,
                    const std::string &type = "T")
{
    SubscribeRule rule;
    rule.Message = message;
    rule.Type = type;
    rule.From = from;
    rule.Line = 20;
    return rule;
}

AcceptRule Accepts(const std::string &queue, const std::vector<std::string> &from = {"*"})
{
    AcceptRule rule;
    rule.Queue = queue;
    rule.Types = {"T"};
    rule.From = from;
    rule.Line = 30;
    return rule;
}

SendRule Sends(const std::string &to, const std::string &queue)
{
    SendRule rule;
    rule.To = to;
    rule.Queue = queue;
    rule.Line = 40;
    return rule;
}

std::vector<std::string> LinesOf(const std::vector<GatewayConfig> &fleet)
{
    std::vector<std::string> lines;
    for (const FleetCheck::Finding &finding : FleetCheck::FindingsOf(fleet))
    {
        lines.push_back(FleetCheck::LineOf(finding));
    }
    return lines;
}

TEST(FleetCheck, AFleetThatFitsTogetherIsGood)
{
    GatewayConfig uav = NodeOf("uav1");
    GatewayConfig ground = NodeOf("ground");
    uav.Publish = {Publishes("Pose")};
    uav.Accept = {Accepts("MissionControl", {"ground"})};
    ground.Subscribe = {Wants("Pose", {"uav?", "uav??"})};
    ground.Send = {Sends("*", "MissionControl"), Sends("*", "*")};
    EXPECT_THAT(LinesOf({uav, ground}), IsEmpty());
}

TEST(FleetCheck, APatternThatNoNodeFitsIsNoProblem)
{
    GatewayConfig ground = NodeOf("ground");
    for (const std::string pattern : {"uav?", "uav2.*", "camera1?", "c*", "*.vision"})
    {
        ground.Subscribe = {Wants("Pose", {pattern})};
        const auto findings = FleetCheck::FindingsOf({NodeOf("my-camera1"), NodeOf("uav1.sonar"), ground});
        ASSERT_THAT(findings, SizeIs(1)) << pattern;
        EXPECT_FALSE(findings[0].IsProblem) << pattern;
        EXPECT_THAT(findings[0].Text, HasSubstr("no other node fits `" + pattern + "`"));
    }
}

TEST(FleetCheck, AMistypedPatternIsAProblem)
{
    GatewayConfig ground = NodeOf("ground");
    for (const std::string pattern : {"uva*", "uaw?", "UAV*"})
    {
        ground.Subscribe = {Wants("Pose", {pattern})};
        const auto findings = FleetCheck::FindingsOf({NodeOf("uav1"), ground});
        ASSERT_THAT(findings, SizeIs(1)) << pattern;
        EXPECT_TRUE(findings[0].IsProblem) << pattern;
        EXPECT_THAT(findings[0].Text, HasSubstr("did you mean `uav1`?")) << pattern;
    }
}

TEST(FleetCheck, OfANodeAloneNothingIsSaidOfWhatItWants)
{
    GatewayConfig ground = NodeOf("ground");
    ground.Subscribe = {Wants("Pose", {"uav1"})};
    ground.Send = {Sends("uav1", "MissionControl")};
    EXPECT_THAT(LinesOf({ground}), IsEmpty());
}

TEST(FleetCheck, TwoNodesOfOneNameAreToldUnlessTheyAreGatewaysOfOneProcess)
{
    GatewayConfig other = NodeOf("uav1");
    other.File = "other.yaml";
    EXPECT_THAT(LinesOf({NodeOf("uav1"), other}),
                ElementsAre("other.yaml:1: two nodes are called `uav1`; the other one is in uav1.yaml"));
    other.Domain = 7;
    other.Name = "Radio";
    EXPECT_THAT(LinesOf({NodeOf("uav1"), other}), IsEmpty());
}

TEST(FleetCheck, AgreementsThatDifferAndMembersWithoutOneAreTold)
{
    GatewayConfig one = NodeOf("uav1");
    one.Lines["agreement"] = 5;
    one.Agreement.emplace().Members = {"uav1", "uav2"};
    GatewayConfig other = NodeOf("uav2");
    other.Lines["agreement"] = 5;
    other.Agreement.emplace().Members = {"uav2", "uav1"};
    EXPECT_THAT(LinesOf({one, other}), IsEmpty());
    const std::string differs =
        "uav2.yaml:5: `agreement` has other members, or another lease, than that of `uav1` in uav1.yaml; all "
        "members need the same";
    other.Agreement->Lease = std::chrono::seconds(4);
    EXPECT_THAT(LinesOf({one, other}), ElementsAre(differs));
    other.Agreement->Lease = one.Agreement->Lease;
    other.Agreement->Members.push_back("uav3");
    EXPECT_THAT(LinesOf({one, other}), ElementsAre(differs));
    other.Agreement.reset();
    EXPECT_THAT(LinesOf({one, other, NodeOf("uav3")}),
                ElementsAre("uav2.yaml:1: `uav2` is a member of the `agreement` in uav1.yaml, and has none "
                            "itself: it does not vote"));
}

TEST(FleetCheck, DomainsThatDoNotHearEachOtherAreTold)
{
    GatewayConfig lost = NodeOf("uav3");
    lost.Domain = 8;
    EXPECT_THAT(LinesOf({NodeOf("uav1"), NodeOf("uav2"), lost}),
                ElementsAre("uav3.yaml:2: domain 8 does not hear domain 0, where `uav1`, `uav2` are"));
}

TEST(FleetCheck, DomainsThatOneProcessJoinsAreGood)
{
    GatewayConfig radio = NodeOf("uav1");
    radio.Domain = 8;
    radio.Name = "Radio";
    GatewayConfig ground = NodeOf("ground");
    ground.Domain = 8;
    EXPECT_THAT(LinesOf({NodeOf("uav1"), radio, ground}), IsEmpty());
}

TEST(FleetCheck, TransportsThatDifferAreWorthKnowingAndNoProblem)
{
    GatewayConfig other = NodeOf("uav2");
    other.Transport = "cyclonedds";
    const auto findings = FleetCheck::FindingsOf({NodeOf("uav1"), other});
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_FALSE(findings[0].IsProblem);
    EXPECT_EQ(FleetCheck::LineOf(findings[0]),
              "uav2.yaml:3: note: the transport is `cyclonedds`, that of uav1 `fastdds`; they understand "
              "each other");
}

TEST(FleetCheck, WithoutMulticastANodeOfTheDomainMustNameAPeer)
{
    const char *const problem =
        "uav1.yaml:4: without multicast this node finds no other: no file of domain 0 names `peers`";
    GatewayConfig deaf = NodeOf("uav1");
    deaf.Multicast = false;
    GatewayConfig other = NodeOf("uav2");
    EXPECT_THAT(LinesOf({deaf, other}), ElementsAre(problem));
    GatewayConfig elsewhere = NodeOf("uav2");
    elsewhere.Domain = 8;
    elsewhere.Name = "Radio";
    elsewhere.Peers = {"10.0.0.1"};
    EXPECT_THAT(LinesOf({deaf, other, elsewhere}), ElementsAre(problem));
    other.Peers = {"10.0.0.1"};
    EXPECT_THAT(LinesOf({deaf, other, elsewhere}), IsEmpty());
}

TEST(FleetCheck, OfANodeAloneInItsDomainItIsNotToldThatNoPeerIsNamed)
{
    GatewayConfig radio = NodeOf("uav1");
    radio.Domain = 8;
    radio.Name = "Radio";
    radio.Multicast = false;
    EXPECT_THAT(LinesOf({NodeOf("uav1"), NodeOf("uav2"), radio}), IsEmpty());
}

TEST(FleetCheck, WhatNobodyPublishesIsToldWithTheNearestName)
{
    GatewayConfig uav = NodeOf("uav1");
    GatewayConfig ground = NodeOf("ground");
    uav.Publish = {Publishes("Pose"), Publishes("Health")};
    ground.Subscribe = {Wants("Poze", {"*"})};
    EXPECT_THAT(LinesOf({uav, ground}), ElementsAre("ground.yaml:20: subscribe Poze: nobody publishes it; "
                                                    "did you mean `Pose`?"));
}

TEST(FleetCheck, ANameOrPatternMeansEachNodeThatFitsAndAStarWhoeverHasIt)
{
    GatewayConfig uav = NodeOf("uav1");
    GatewayConfig ground = NodeOf("ground");
    uav.Publish = {Publishes("Pose")};
    ground.Subscribe = {Wants("Pose", {"uav*"})};
    EXPECT_THAT(LinesOf({uav, NodeOf("uav2"), ground}),
                ElementsAre("ground.yaml:20: subscribe Pose: uav2 does not publish it"));
    ground.Subscribe = {Wants("Pose", {"*"})};
    EXPECT_THAT(LinesOf({uav, NodeOf("uav2"), ground}), IsEmpty());
}

TEST(FleetCheck, ANodeThatIsNotThereIsToldWithTheNearestName)
{
    GatewayConfig uav = NodeOf("uav1");
    uav.Subscribe = {Wants("SearchArea", {"grond"})};
    uav.Accept = {Accepts("MissionControl", {"ground", "grund"})};
    GatewayConfig ground = NodeOf("ground");
    ground.Publish = {Publishes("SearchArea")};
    EXPECT_THAT(
        LinesOf({uav, ground}),
        ElementsAre(
            "uav1.yaml:20: subscribe SearchArea: no other node is called `grond`; did you mean `ground`?",
            "uav1.yaml:30: accept MissionControl: no other node is called `grund`; did you mean "
            "`ground`?"));
}

TEST(FleetCheck, ANodeInAnotherDomainIsToldSo)
{
    GatewayConfig uav = NodeOf("uav1");
    GatewayConfig ground = NodeOf("ground");
    ground.Domain = 8;
    uav.Subscribe = {Wants("SearchArea", {"ground"})};
    EXPECT_THAT(LinesOf({uav, NodeOf("uav2"), ground}),
                ElementsAre("ground.yaml:2: domain 8 does not hear domain 0, where `uav1`, `uav2` are",
                            "uav1.yaml:20: subscribe SearchArea: ground is in domain 8, this node in 0"));
}

TEST(FleetCheck, TypesThatDifferAreTold)
{
    GatewayConfig uav = NodeOf("uav1");
    GatewayConfig other = NodeOf("uav2");
    GatewayConfig ground = NodeOf("ground");
    uav.Publish = {Publishes("Pose", "Uav::Pose")};
    other.Publish = {Publishes("Pose", "Uav::Position")};
    ground.Subscribe = {Wants("Pose", {"*"}, "Uav::Pose")};
    EXPECT_THAT(
        LinesOf({uav, other, ground}),
        ElementsAre("uav2.yaml:10: `Pose` is published as `Uav::Position`, by uav1 as `Uav::Pose`",
                    "ground.yaml:20: subscribe Pose: uav2 publishes it as `Uav::Position`, this node wants "
                    "`Uav::Pose`"));
}

TEST(FleetCheck, AStateIsNotHadOfTelemetry)
{
    GatewayConfig uav = NodeOf("uav1");
    GatewayConfig ground = NodeOf("ground");
    uav.Publish = {Publishes("Pose")};
    uav.Publish[0].Qos = QosProfile::Telemetry;
    ground.Subscribe = {Wants("Pose", {"*"})};
    EXPECT_THAT(LinesOf({uav, ground}), IsEmpty());
    ground.Subscribe[0].Qos = QosProfile::State;
    EXPECT_THAT(
        LinesOf({uav, ground}),
        ElementsAre("ground.yaml:20: subscribe Pose: uav1 publishes it with qos telemetry, this node wants "
                    "qos state"));
}

TEST(FleetCheck, QueuesThatNobodyAcceptsAreToldWithTheNearestName)
{
    GatewayConfig uav = NodeOf("uav1");
    GatewayConfig ground = NodeOf("ground");
    uav.Accept = {Accepts("MissionControl")};
    ground.Send = {Sends("*", "MissionContrl"), Sends("uav1", "MissionControls")};
    EXPECT_THAT(
        LinesOf({uav, ground}),
        ElementsAre("ground.yaml:40: send */MissionContrl: nobody accepts such a queue; did you mean "
                    "`MissionControl`?",
                    "ground.yaml:40: send uav1/MissionControls: uav1 does not accept such a queue; did you "
                    "mean `MissionControl`?"));
}

TEST(FleetCheck, ASenderThatNobodyAcceptsFromIsTold)
{
    GatewayConfig uav = NodeOf("uav1");
    GatewayConfig ground = NodeOf("ground");
    uav.Accept = {Accepts("MissionControl", {"uav2"})};
    ground.Send = {Sends("*", "MissionControl")};
    EXPECT_THAT(
        LinesOf({uav, NodeOf("uav2"), ground}),
        ElementsAre("ground.yaml:40: send */MissionControl: `uav1` accepts it from others only, not from "
                    "ground"));
}

TEST(FleetCheck, ASenderWithoutAFileMayBeATool)
{
    GatewayConfig uav = NodeOf("uav1");
    uav.Accept = {Accepts("MissionControl", {"ground", "laptop"})};
    EXPECT_THAT(LinesOf({uav, NodeOf("ground")}),
                ElementsAre("uav1.yaml:30: note: accept MissionControl: none of the files is of `laptop`; a "
                            "tool of that name may send (`rabit send --node`)"));
}

TEST(FleetCheck, TheSameOfSeveralNodesOfOneFileIsOneLine)
{
    GatewayConfig one = NodeOf("uav1");
    GatewayConfig two = NodeOf("uav2");
    one.File = two.File = "uav.yaml";
    one.Subscribe = two.Subscribe = {Wants("SearchArea", {"ground"})};
    EXPECT_THAT(
        LinesOf({one, two, NodeOf("base")}),
        ElementsAre("uav.yaml:20: subscribe SearchArea: no other node is called `ground`; expected one of "
                    "`uav2`, `base`",
                    "uav.yaml:20: subscribe SearchArea: no other node is called `ground`; expected one of "
                    "`uav1`, `base`"));
    one.Subscribe = two.Subscribe = {Wants("SearchArea", {"base"})};
    EXPECT_THAT(LinesOf({one, two, NodeOf("base")}),
                ElementsAre("uav.yaml:20: subscribe SearchArea: base does not publish it (`uav1`, `uav2`)"));
}

}  // namespace
}  // namespace Rabit::Tool
