#include "RosNodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "RosParticipant.h"

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

const std::string Talker = "0102030405060708090a0b0c";
const std::string Camera = "ff02030405060708090a0b0c";

class RosNodesTest : public ::testing::Test
{
protected:
    RosNodesTest()
    {
        nodes.Attach(workspace);
        workspace.AddPublishSubscribeMessage(RosNodes::Topic, posted);
        fleet.foreign.emplace_back().topic = RosNodes::Topic;
    }

    void Announce(const std::string &prefix, const std::vector<std::string> &names)
    {
        posted->Prefix = prefix;
        posted->Nodes = names;
        posted->PostMessage();
    }
    // A participant that discovery knows.
    void Discover(const std::string &prefix)
    {
        fleet.foreign.front().writers.emplace_back().id = prefix + "00000103";
    }

    RabitWorkspace workspace;
    RosNodes nodes;
    std::shared_ptr<RosParticipant> posted = std::make_shared<RosParticipant>();
    Gateway::Fleet fleet;
};

TEST_F(RosNodesTest, AParticipantHasTheNamesThatItAnnouncedLast)
{
    Discover(Talker);
    Discover(Camera);
    Announce(Talker, {"/talker"});
    Announce(Camera, {"/uav1/camera"});
    Announce(Talker, {"/talker", "/listener"});
    EXPECT_THAT(nodes.Of(fleet), ElementsAre(Pair(Talker, ElementsAre("/talker", "/listener")),
                                             Pair(Camera, ElementsAre("/uav1/camera"))));
}

TEST_F(RosNodesTest, AParticipantWithoutAnAnnouncementHasNoNames)
{
    Discover(Talker);
    EXPECT_THAT(nodes.Of(fleet), ElementsAre(Pair(Talker, IsEmpty())));
}

TEST_F(RosNodesTest, AParticipantThatDiscoveryDoesNotKnowIsNotThere)
{
    Announce(Talker, {"/talker"});
    EXPECT_THAT(nodes.Of(fleet), IsEmpty());
}

TEST_F(RosNodesTest, NamesOfABoundedNumberOfParticipantsAreKept)
{
    for (std::size_t i = 0; i <= RosNodes::MostParticipants; ++i)
    {
        const std::string prefix = std::to_string(100'000'000 + i) + std::string(15, '0');
        Discover(prefix);
        Announce(prefix, {"/talker"});
    }
    std::size_t named = 0;
    for (const auto &[prefix, names] : nodes.Of(fleet))
    {
        named += names.size();
    }
    EXPECT_EQ(named, RosNodes::MostParticipants);
}

TEST_F(RosNodesTest, AToolReadsTheTopicAsRosWritesItAndOneWithKeysDoesNot)
{
    GatewayConfig config;
    config.Node = "tool";
    config.Tool.emplace();
    config.Security.emplace();
    config.Security->Keys = "keys";
    RosNodes::AddTo(config);
    EXPECT_THAT(config.Foreign, IsEmpty());
    config.Security.reset();
    RosNodes::AddTo(config);
    ASSERT_EQ(config.Foreign.size(), 1U);
    EXPECT_EQ(config.Foreign[0].Reliability, Reliability::Reliable);
    EXPECT_EQ(config.Foreign[0].Durability, Durability::TransientLocal);
    EXPECT_NO_THROW(ValidateGatewayConfig(config));
}

}  // namespace
}  // namespace Rabit::Tool
