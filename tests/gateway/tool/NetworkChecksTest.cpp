#include "doctor/NetworkChecks.h"

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

class NetworkChecks : public ::testing::Test
{
protected:
    NetworkChecks()
    {
        Interface wlan;
        wlan.Name = "wlan0";
        wlan.Addresses = {"10.0.0.2"};
        wlan.IsUp = wlan.HasMulticast = true;
        used.push_back(wlan);
        facts.Trials["wlan0"].HeardOn = {"wlan0"};
        facts.Trials["wlan0"].HeardFrom = {"10.0.0.3"};
        facts.Trials["wlan0"].AnsweredFrom = {"10.0.0.3"};
    }

    Finding Multicast() const
    {
        const auto findings = OfMulticast(config, used, facts, heardBy);
        EXPECT_THAT(findings, ::testing::Not(IsEmpty()));
        return findings.empty() ? Finding() : findings.front();
    }

    MulticastTrial &Trial() { return facts.Trials["wlan0"]; }

    GatewayConfig config;
    std::vector<Interface> used;
    NetworkFacts facts;
    std::set<std::string> heardBy;
};

TEST_F(NetworkChecks, MulticastThatGoesEachWayIsGood)
{
    EXPECT_EQ(Multicast().How, Level::Good);
    EXPECT_EQ(Multicast().Text, "it goes out; answered by 10.0.0.3; heard from 10.0.0.3");
}

TEST_F(NetworkChecks, ProgramsOfRosHaveTheNamesOfTheirNodes)
{
    const std::string named = "0102030405060708090a0b0c";
    const std::string nameless = "ff02030405060708090a0b0c";
    const std::string label = "a program of ROS 2 (";
    facts.Domains[0]["10.0.0.3"].Names = {"ground", label + named + ")", label + nameless + ")"};
    facts.OnLoopbackAlone = {label + named + ")"};
    RosNodes::Names programs;
    programs[named] = {"/talker", "/uav1/camera"};
    programs[nameless].clear();
    NameRosPrograms(programs, facts);
    EXPECT_THAT(
        facts.Domains[0]["10.0.0.3"].Names,
        ElementsAre(label + "/talker /uav1/camera, " + named + ")", label + nameless + ")", "ground"));
    EXPECT_THAT(facts.OnLoopbackAlone, ElementsAre(label + "/talker /uav1/camera, " + named + ")"));
}

TEST_F(NetworkChecks, ProgramsOnOtherInterfacesCannotBeReached)
{
    config.Domain = 7;
    facts.Elsewhere[8]["eth0"] = {"192.168.0.9"};
    EXPECT_THAT(OfOtherInterfaces(config, used, facts, false), IsEmpty());
    facts.Elsewhere[7]["eth0"] = {"192.168.0.9"};
    const auto findings = OfOtherInterfaces(config, used, facts, false);
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].How, Level::Problem);
    EXPECT_EQ(findings[0].Subject, "interface eth0");
    EXPECT_EQ(findings[0].Text,
              "192.168.0.9 is heard there in domain 7, and cannot be reached: only wlan0 is used");
    EXPECT_THAT(findings[0].Advice, HasSubstr("--interface eth0"));
    EXPECT_EQ(OfOtherInterfaces(config, used, facts, true)[0].How, Level::Note);
}

TEST_F(NetworkChecks, ProgramsThatTakeNoMulticastAreTold)
{
    EXPECT_THAT(OfLoopback(config, used, facts), IsEmpty());
    facts.OnLoopbackAlone = {"a program of ROS 2 (0102030405060708090a0b0c)"};
    auto findings = OfLoopback(config, used, facts);
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].How, Level::Note) << "it may belong to something else";
    EXPECT_EQ(findings[0].Text,
              "a program of ROS 2 (0102030405060708090a0b0c) is in domain 0 on this machine, "
              "and takes no multicast: nodes without `peers` do not meet it");
    EXPECT_THAT(findings[0].Advice, HasSubstr("list 127.0.0.1 in `peers`"));
    used[0].IsLoopback = true;
    EXPECT_EQ(OfLoopback(config, used, facts)[0].How, Level::Problem);
    used.clear();
    EXPECT_EQ(OfLoopback(config, used, facts)[0].How, Level::Note);
    config.Peers = {"10.0.0.9", "127.0.0.1"};
    EXPECT_THAT(OfLoopback(config, used, facts), IsEmpty());
}

TEST_F(NetworkChecks, WhatCannotBeSentIsAProblemWithTheRouteThatLacks)
{
    Trial() = {};
    Trial().Error = "Network is unreachable";
    EXPECT_EQ(Multicast().How, Level::Problem);
    EXPECT_THAT(Multicast().Text, HasSubstr("Network is unreachable"));
    EXPECT_EQ(Multicast().Advice, "ip route add 224.0.0.0/4 dev wlan0");
    used[0].HasMulticast = false;
    EXPECT_EQ(Multicast().Advice, "ip link set wlan0 multicast on");
}

TEST_F(NetworkChecks, WhatDoesNotComeBackIsStoppedHere)
{
    Trial() = {};
    EXPECT_EQ(Multicast().How, Level::Problem);
    EXPECT_THAT(Multicast().Advice, HasSubstr("firewall"));
}

TEST_F(NetworkChecks, WhoIsHeardAndDoesNotAnswerIsHeardOneWay)
{
    Trial().AnsweredFrom.clear();
    EXPECT_EQ(Multicast().How, Level::Problem);
    EXPECT_THAT(Multicast().Text, HasSubstr("10.0.0.3 is heard, and did not answer"));
}

TEST_F(NetworkChecks, AnAddressWithANodeThatHearsThisProgramNeedNotAnswer)
{
    Trial().AnsweredFrom.clear();
    facts.Domains[config.Domain]["10.0.0.3"] = {{"uav1"}, true};
    EXPECT_EQ(Multicast().How, Level::Problem);
    heardBy = {"uav1"};
    EXPECT_EQ(Multicast().How, Level::Note);
}

TEST_F(NetworkChecks, ParticipantsThatAreNoNodesAreNamed)
{
    facts.Domains[config.Domain]["10.0.0.3"] = {{"rviz", "uav1"}, true};
    facts.Domains[config.Domain + 1]["10.0.0.3"] = {{"other"}, true};
    const auto findings = OfOtherParticipants(config, facts, {"uav1"});
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].How, Level::Note);
    EXPECT_THAT(findings[0].Text, HasSubstr("rviz is heard in domain 0 and not among the nodes"));
    EXPECT_THAT(OfOtherParticipants(config, facts, {"rviz", "uav1"}), IsEmpty());
}

TEST_F(NetworkChecks, WhoAnswersAndAnnouncedNothingMeanwhileIsGood)
{
    Trial().HeardFrom.clear();
    EXPECT_EQ(Multicast().How, Level::Good);
}

TEST_F(NetworkChecks, NobodyAtAllIsWorthKnowing)
{
    Trial().HeardFrom.clear();
    Trial().AnsweredFrom.clear();
    EXPECT_EQ(Multicast().How, Level::Note);
}

TEST_F(NetworkChecks, OneInterfaceThatHearsTheOtherIsTold)
{
    Trial().HeardOn.insert("eth1");
    EXPECT_THAT(Multicast().Text, HasSubstr("comes in on eth1"));
}

TEST_F(NetworkChecks, WithoutMulticastNothingIsSaidOfIt)
{
    config.Multicast = false;
    EXPECT_THAT(OfMulticast(config, used, facts, heardBy), IsEmpty());
}

TEST_F(NetworkChecks, OnlyPathsWithMulticastAreLookedAtForIt)
{
    used.front().IsUp = true;
    used.front().Addresses = {"10.0.0.2"};
    config.Interfaces.clear();
    config.Paths = {{.Name = "mesh", .Interfaces = {"wlan0"}},
                    {.Name = "modem", .Interfaces = {"ppp0"}, .Multicast = false}};
    EXPECT_EQ(Multicast().Subject, "multicast on wlan0");
    config.Paths.front().Multicast = false;
    EXPECT_THAT(OfMulticast(config, used, facts, heardBy), IsEmpty());
}

TEST_F(NetworkChecks, NodesOfAnotherDomainAreAProblemIfNobodyIsInOurs)
{
    config.Domain = 7;
    facts.Domains[7]["10.0.0.3"] = {{"uav1"}, true};
    facts.Domains[8]["10.0.0.4"] = {{"uav2"}, true};
    const auto findings = OfDomains(config, facts, true);
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].How, Level::Note);
    EXPECT_EQ(findings[0].Text, "uav2 is in it, at 10.0.0.4");
    EXPECT_EQ(OfDomains(config, facts, false)[0].How, Level::Problem);
    EXPECT_THAT(OfDomains(config, facts, false)[0].Advice, HasSubstr("--domain 8"));
}

TEST_F(NetworkChecks, DomainsThatWereOnlyListenedToAreNamedIfNoNodeWasFound)
{
    config.Domain = 42;
    facts.Domains[3]["10.0.0.4"] = {{"rviz"}, false};
    const auto findings = OfSilentDomains(config, facts, false, 10, 12.0);
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].How, Level::Note);
    EXPECT_THAT(findings[0].Text,
                HasSubstr("no node is in domains 0 to 9 and 42; the other domains were only listened "
                          "to, for 12 s"));
    config.Domain = 0;
    EXPECT_THAT(OfSilentDomains(config, facts, false, 10, 12.0)[0].Text,
                HasSubstr("no node is in domains 0 to 9; the other"));
    config.Domain = 42;
    EXPECT_THAT(OfSilentDomains(config, facts, true, 10, 12.0), IsEmpty());
    facts.Domains[8]["10.0.0.4"] = {{"uav2"}, true};
    EXPECT_THAT(OfSilentDomains(config, facts, false, 10, 12.0), IsEmpty());
}

TEST_F(NetworkChecks, NodesWithKeysAreAProblemForAProgramWithoutKeys)
{
    config.Domain = 7;
    facts.Domains[7]["10.0.0.3"] = {{"plain"}, true, {1}};
    facts.Domains[7]["10.0.0.20"] = {{}, false, {2, 3}};
    facts.Domains[8]["10.0.0.4"] = {{}, false, {4}};
    const auto findings = OfKeys(config, used, facts, true);
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].How, Level::Problem);
    EXPECT_EQ(findings[0].Text,
              "nodes at 10.0.0.3, 10.0.0.20 in domain 7 have keys, and this program has none: it stays out");
    EXPECT_THAT(findings[0].Advice, HasSubstr("--keys FOLDER"));
}

TEST_F(NetworkChecks, ThatNoneIsHeardWithTheKeysOfThisProgramIsAProblem)
{
    config.Domain = 7;
    config.Security.emplace();
    // The first session is of this program.
    facts.Domains[7]["10.0.0.2"] = {{}, false, {1}};
    EXPECT_THAT(OfKeys(config, used, facts, false), IsEmpty());
    facts.Domains[7]["10.0.0.3"] = {{}, false, {2}};
    const auto lonely = OfKeys(config, used, facts, false);
    ASSERT_THAT(lonely, SizeIs(1));
    EXPECT_EQ(lonely[0].How, Level::Problem);
    // The address of this machine is left out.
    EXPECT_EQ(lonely[0].Text,
              "nodes at 10.0.0.3 in domain 7 have keys, and none is heard with the keys of this program");
    EXPECT_THAT(OfKeys(config, used, facts, true), IsEmpty());
    facts.Domains[7].erase("10.0.0.3");
    facts.Domains[7]["10.0.0.2"].SealedSessions.insert(2);
    EXPECT_THAT(OfKeys(config, used, facts, false).at(0).Text, HasSubstr("nodes at 10.0.0.2 in domain 7"));
}

TEST_F(NetworkChecks, KeysOfOnePathAreKeysOfThisProgram)
{
    PathRule mesh{.Name = "mesh"};
    mesh.Security.emplace();
    config.Paths = {mesh, {.Name = "modem"}};
    EXPECT_EQ(OwnSealedSessions(config), 1U);
    facts.Domains[config.Domain]["10.0.0.3"] = {{"plain"}, false, {1}};
    const auto findings = OfKeys(config, used, facts, false);
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_THAT(findings[0].Text, HasSubstr("plain in domain 0 has no keys"));
}

TEST_F(NetworkChecks, ASessionOfThisProgramIsNoNodeThatWasFound)
{
    config.Security.emplace();
    facts.Domains[config.Domain]["10.0.0.2"] = {{}, false, {1}};
    EXPECT_THAT(OfSilentDomains(config, facts, false, 10, 12.0), SizeIs(1));
    facts.Domains[3]["10.0.0.3"] = {{}, false, {2}};
    EXPECT_THAT(OfSilentDomains(config, facts, false, 10, 12.0), IsEmpty());
}

TEST_F(NetworkChecks, ANodeIsHeardIfItHasNoKeysOrIfMoreSessionsHaveKeysThanThoseOfThisProgram)
{
    EXPECT_FALSE(IsNodeHeard(facts, 7, 0));
    facts.Domains[7]["10.0.0.4"] = {{"a program of ROS 2"}, false};
    facts.Domains[8]["10.0.0.4"] = {{"uav1"}, true};
    EXPECT_FALSE(IsNodeHeard(facts, 7, 0));
    // A session that is heard at two addresses counts once.
    facts.Domains[7]["10.0.0.2"].SealedSessions = {1};
    facts.Domains[7]["127.0.0.1"].SealedSessions = {1};
    EXPECT_FALSE(IsNodeHeard(facts, 7, 1));
    EXPECT_TRUE(IsNodeHeard(facts, 7, 0));
    facts.Domains[7]["10.0.0.3"].SealedSessions = {2};
    EXPECT_TRUE(IsNodeHeard(facts, 7, 1));
    facts.Domains[7]["10.0.0.5"] = {{"uav1"}, true};
    EXPECT_TRUE(IsNodeHeard(facts, 7, 9));
}

TEST_F(NetworkChecks, AProgramWithoutKeysIsANoteForOneWithKeys)
{
    config.Security.emplace();
    facts.Domains[config.Domain]["10.0.0.3"] = {{"plain"}, false, {1}};
    const auto findings = OfKeys(config, used, facts, true);
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].How, Level::Note);
    EXPECT_EQ(findings[0].Text, "plain in domain 0 has no keys: what it says is not heard");
}

TEST_F(NetworkChecks, KeysAreNoMatterWhereNobodyHasSome)
{
    facts.Domains[config.Domain]["10.0.0.3"] = {{"uav1"}, true};
    EXPECT_THAT(OfKeys(config, used, facts, true), IsEmpty());
    EXPECT_THAT(OfKeys(config, used, facts, false), IsEmpty());
}

TEST_F(NetworkChecks, NodesWithKeysInAnotherDomainAreAProblemIfNobodyIsInOurs)
{
    facts.Domains[8]["10.0.0.4"] = {{}, false, {1}};
    const auto findings = OfDomains(config, facts, false);
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_EQ(findings[0].How, Level::Problem);
    EXPECT_THAT(findings[0].Text, HasSubstr("a node with keys is in it, at 10.0.0.4"));
}

TEST_F(NetworkChecks, WithKeysNoAnswerOfProgramsWithoutKeysIsMissed)
{
    config.Security.emplace();
    Trial().HeardFrom.clear();
    Trial().AnsweredFrom.clear();
    EXPECT_EQ(Multicast().How, Level::Good);
    EXPECT_EQ(Multicast().Text, "it goes out; nobody without keys answered");
}

TEST_F(NetworkChecks, ProgramsThatAreNoNodesAreNeverAProblem)
{
    facts.Domains[8]["10.0.0.4"] = {{"rviz"}, false};
    EXPECT_EQ(OfDomains(config, facts, false)[0].How, Level::Note);
    EXPECT_THAT(OfDomains(config, facts, false)[0].Text, HasSubstr("rviz is in it"));
}

}  // namespace
}  // namespace Rabit::Tool::Doctor
