#include "Offers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/base/NaturalOrder.h>

#include <algorithm>
#include <string>
#include <vector>

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

FleetSession::Node NodeOf(const std::string &name, const std::string &message, const std::string &type,
                          std::uint64_t definition)
{
    FleetSession::Node node;
    node.Name = name;
    node.State = Gateway::NodeState::UP;
    node.Offers.emplace();
    Gateway::PublishedMessage published;
    published.message = message;
    published.type = type;
    published.qos = "state";
    published.definition = definition;
    node.Offers->publishes.push_back(published);
    return node;
}

TEST(Offers, AMessageOfSeveralNodesIsOne)
{
    const auto messages =
        Offers::MessagesOf({NodeOf("uav1", "Pose", "Uav::Pose", 1), NodeOf("uav2", "Pose", "Uav::Pose", 1)});
    ASSERT_THAT(messages, SizeIs(1));
    EXPECT_THAT(messages[0].Publishers, ElementsAre("uav1", "uav2"));
}

FleetSession::Node Silent(FleetSession::Node node)
{
    node.Offers.reset();
    return node;
}

FleetSession::Node Lost(FleetSession::Node node)
{
    node.State = Gateway::NodeState::LOST;
    return node;
}

FleetSession::Node Aircraft(const std::string &name)
{
    return NodeOf(name, "Pose", "Uav::Pose", 1);
}

TEST(Offers, TheAnnouncementOfTheNamedNodeIsAllThatCanCome)
{
    EXPECT_TRUE(Offers::AreAllThere({Aircraft("uav1"), Silent(Aircraft("uav2"))}, "uav1", false));
    EXPECT_FALSE(Offers::AreAllThere({Silent(Aircraft("uav1"))}, "uav1", true));
}

TEST(Offers, AFleetIsKnownIfAllLiveNodesHearTheSame)
{
    auto near = Aircraft("uav1");
    auto far = Aircraft("uav2");
    near.HearsTheSame = true;
    EXPECT_FALSE(Offers::DoAllHearTheSame({}));
    EXPECT_TRUE(Offers::DoAllHearTheSame({near}));
    EXPECT_FALSE(Offers::DoAllHearTheSame({near, far}));
    EXPECT_TRUE(Offers::DoAllHearTheSame({near, Lost(far)}));
    EXPECT_FALSE(Offers::DoAllHearTheSame({Lost(far)}));
}

TEST(Offers, OfANodeThatWasNotHeardNothingCanComeOnceEverybodyWasHeard)
{
    EXPECT_FALSE(Offers::AreAllThere({Aircraft("uav1")}, "uav2", false));
    EXPECT_TRUE(Offers::AreAllThere({Aircraft("uav1")}, "uav2", true));
    EXPECT_TRUE(Offers::AreAllThere({Aircraft("uav1"), Lost(Aircraft("uav2"))}, "uav2", true));
    EXPECT_FALSE(Offers::AreAllThere({}, "uav2", true));
}

TEST(Offers, OfAPatternNothingCanComeOnceAllThatFitHaveAnnouncedThemselves)
{
    EXPECT_FALSE(Offers::AreAllThere({Aircraft("uav1")}, "*", false));
    EXPECT_TRUE(Offers::AreAllThere({Aircraft("uav1"), Silent(Aircraft("ground"))}, "uav*", true));
    EXPECT_FALSE(Offers::AreAllThere({Aircraft("uav1"), Silent(Aircraft("uav2"))}, "uav*", true));
}

TEST(Offers, EverybodyIsHeardWithinTwoPeriodsOfTheNodeThatBeatsMostSeldom)
{
    auto often = Aircraft("uav1");
    often.BeatPeriod = 0.5;
    auto seldom = Aircraft("uav2");
    seldom.BeatPeriod = 2.0;
    EXPECT_EQ(Offers::SecondsToHearEverybody({}), 1.5);
    EXPECT_EQ(Offers::SecondsToHearEverybody({often}), 1.5);
    EXPECT_EQ(Offers::SecondsToHearEverybody({seldom, often}), 4.0);
}

TEST(Offers, AnotherAircraftIsNotProposedForOneThatIsNotThere)
{
    EXPECT_EQ(Offers::NoSuchNode("uav2", {Aircraft("ground"), Aircraft("uav1")}, 1.5),
              "node `uav2` was not heard within 1.5 s; there: `ground`, `uav1`");
    EXPECT_EQ(Offers::NoSuchNode("uav2.vison", {Aircraft("uav1.vision")}, 1.5),
              "node `uav2.vison` was not heard within 1.5 s; there: `uav1.vision`");
}

TEST(Offers, AMistypedNameIsAnsweredWithTheNodeThatIsMeant)
{
    EXPECT_EQ(Offers::NoSuchNode("uaw1", {Aircraft("ground"), Aircraft("uav1")}, 1.5),
              "node `uaw1` was not heard within 1.5 s; did you mean `uav1`?");
}

TEST(Offers, ALostNodeIsNamedAsLostAndNeverProposed)
{
    EXPECT_EQ(Offers::NoSuchNode("uav2", {Aircraft("uav1"), Lost(Aircraft("uav2"))}, 1.5),
              "node `uav2` is LOST; there: `uav1`");
    EXPECT_EQ(Offers::NoSuchNode("uaw2", {Aircraft("uav1"), Lost(Aircraft("uav2"))}, 1.5),
              "node `uaw2` was not heard within 1.5 s; there: `uav1`");
}

TEST(Offers, AHundredNodesAreOneLineForEachMessage)
{
    std::vector<FleetSession::Node> nodes;
    for (int i = 1; i <= 100; ++i)
    {
        nodes.push_back(NodeOf("uav" + std::to_string(i), "Pose", "Uav::Pose", i == 100 ? 2 : 1));
    }
    const auto messages = Offers::MessagesOf(nodes);
    ASSERT_THAT(messages, SizeIs(2));
    EXPECT_THAT(messages[0].Publishers, SizeIs(99));
    EXPECT_THAT(Offers::Differences(nodes), SizeIs(1));
}

TEST(Offers, AMessageOfTwoTypesOrDefinitionsIsTwo)
{
    EXPECT_THAT(
        Offers::MessagesOf({NodeOf("uav1", "Pose", "Uav::Pose", 1), NodeOf("uav2", "Pose", "Uav::Pose", 2),
                            NodeOf("uav3", "Pose", "Uav::Other", 1)}),
        SizeIs(3));
}

TEST(Offers, DefinitionsThatDifferAreToldWithWhoHasWhich)
{
    EXPECT_THAT(
        Offers::Differences({NodeOf("uav1", "Pose", "Uav::Pose", 1), NodeOf("uav2", "Pose", "Uav::Pose", 1)}),
        IsEmpty());
    EXPECT_THAT(
        Offers::Differences({NodeOf("uav1", "Pose", "Uav::Pose", 1), NodeOf("uav2", "A", "Uav::Pose", 0xab)}),
        ElementsAre("nodes were built with different definitions of `Uav::Pose`: uav1 with "
                    "0000000000000001; uav2 with 00000000000000ab"));
}

TEST(Offers, DefinitionsThatDifferNameNodesInTheirNaturalOrder)
{
    const auto lines =
        Offers::Differences({NodeOf("uav10", "Pose", "Uav::Pose", 1), NodeOf("uav2", "Pose", "Uav::Pose", 1),
                             NodeOf("uav3", "Pose", "Uav::Pose", 2)});
    ASSERT_THAT(lines, SizeIs(1));
    EXPECT_THAT(lines[0], ::testing::HasSubstr("`Uav::Pose`: uav2, uav10 with"));
}

TEST(NaturalOrder, ComparesNumbersByTheirValueAlsoWithLeadingZeros)
{
    const std::vector<std::string> ordered{"Uav1",   "uav",     "uav01",  "uav1",   "uav2",  "uav09",
                                           "uav010", "uav10.2", "uav10a", "uav011", "uav100"};
    std::vector<std::string> mixed(ordered.rbegin(), ordered.rend());
    std::sort(mixed.begin(), mixed.end(), NaturalOrder());
    EXPECT_EQ(mixed, ordered);
}

TEST(Offers, WhoIsLostOffersNothing)
{
    FleetSession::Node lost = NodeOf("uav1", "Pose", "Uav::Pose", 1);
    lost.State = Gateway::NodeState::LOST;
    EXPECT_THAT(Offers::MessagesOf({lost}), IsEmpty());
    EXPECT_THAT(Offers::TypesOf({lost}), IsEmpty());
    EXPECT_TRUE(Offers::AreComplete({lost}));
}

TEST(Offers, AreNotCompleteWhileSomebodyHasNotAnnouncedItself)
{
    FleetSession::Node silent = NodeOf("uav1", "Pose", "Uav::Pose", 1);
    silent.Offers.reset();
    EXPECT_FALSE(Offers::AreComplete({silent}));
}

}  // namespace
}  // namespace Rabit::Tool
