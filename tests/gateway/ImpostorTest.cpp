// Forged samples of the gateways' topics: whole nodes on the simulated network.
#include <gmock/gmock.h>
#include <rabit/gateway/links/LinkCheck.h>
#include <rabit/gateway/links/LinkFrameCodec.h>

#include "HandNode.h"
#include "SimulatedFleet.h"
#include "gateway.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class ImpostorTest : public ::testing::Test
{
protected:
    ImpostorTest()
        : uav(fleet.Add(AircraftConfig("uav1"))),
          ground(fleet.Add(GroundConfig())),
          impostor(fleet.Network, "uav9", 7)
    {
        fleet.RunFor(2s);
    }

    SimulatedFleet fleet;
    SimulatedNode &uav;
    SimulatedNode &ground;
    HandNode impostor;
};

TEST_F(ImpostorTest, AGoodbyeEndsWhoSaysItAlone)
{
    impostor.Write(impostor.Beat());
    fleet.RunFor(100ms);
    Gateway::Beat goodbye = impostor.Beat();
    goodbye.leaving = true;
    impostor.Write(goodbye);
    fleet.RunFor(100ms);
    EXPECT_EQ(uav.StateOf("uav9"), "LOST");
    EXPECT_EQ(uav.StateOf("ground"), "UP");
}

TEST_F(ImpostorTest, ANodeWhoseGatewayIsOfAnotherVersionIsNamed)
{
    Gateway::Beat beat = impostor.Beat();
    beat.format = BeatFormat::Present + 1;
    impostor.Write(beat);
    fleet.RunFor(1s);
    EXPECT_THAT(uav.Problems(), HasSubstr("node uav9: its gateway speaks another version of presence"));
    EXPECT_EQ(uav.StateOf("uav9"), "");
    fleet.RunFor(11s);
    EXPECT_THAT(uav.Problems(), testing::Not(HasSubstr("uav9")));
}

// Frames of the links name no sender: the sender is the node that DDS reports as the writer.
class StrangeLinkTest : public ::testing::Test
{
protected:
    StrangeLinkTest() : uav(fleet.Add(AircraftConfig("uav1"))) { fleet.RunFor(2s); }

    void Write(const std::string &node, const std::vector<std::uint8_t> &frame)
    {
        TransportSettings settings;
        settings.Node = node;
        settings.Incarnation = 7;
        const auto session = SimulatedTransport(fleet.Network).Open(settings, [](const PeerEvent &) {});
        TopicQos qos;
        qos.Reliability = Reliability::BestEffort;
        const auto writer = session->CreateWriter({"rabit/Link", "Rabit::Gateway::LinkSample", {}}, qos, {});
        fleet.RunFor(1s);
        Gateway::LinkSample sample;
        sample.frame = frame;
        EXPECT_EQ(writer->Write(MessageSample(sample), 0), WriteResult::Ok);
        fleet.RunFor(1s);
    }

    SimulatedFleet fleet;
    SimulatedNode &uav;
};

TEST_F(StrangeLinkTest, AFrameOfANodeWithAnImpossibleNameIsNotTakenIn)
{
    const std::uint64_t before = uav.Fleet().malformed;
    LinkFrame hello;
    hello.Check = LinkCheck::OfName("uav1");
    hello.SenderLife = 1ULL << 32;
    hello.Clock = 1;
    hello.Ask = true;
    std::vector<std::uint8_t> bytes(LinkFrameCodec::EncodedSize(hello));
    LinkFrameCodec::Encode(hello, bytes);
    Write("*", bytes);
    EXPECT_GT(uav.Fleet().malformed, before);
}

TEST_F(StrangeLinkTest, ANodeThatSpeaksAnotherVersionOfTheLinksIsNamed)
{
    Write("uav7", {LinkVersion + 4, 1, 2, 3});
    EXPECT_THAT(uav.Problems(), HasSubstr("node uav7"));
    EXPECT_THAT(uav.Problems(), HasSubstr("speaks version 8 of the queue links, this one version 4"));
}

TEST_F(StrangeLinkTest, BytesThatAreNoFrameAreCounted)
{
    const std::uint64_t before = uav.Fleet().malformed;
    Write("uav7", {LinkVersion, 0xff});
    EXPECT_EQ(uav.Fleet().malformed, before + 1);
}

TEST_F(ImpostorTest, HonestNodesAreNotSuspected)
{
    uav.AddIdleManager("MissionControl");
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
    fleet.RunFor(2s);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").delivered, 1u);
    EXPECT_EQ(uav.Fleet().malformed, 0u);
    EXPECT_EQ(ground.Fleet().malformed, 0u);
}

TEST(AcceptFrom, ANodeThatIsNotWantedIsRefusedAtTheCallAndLearnsWhy)
{
    SimulatedFleet fleet;
    GatewayConfig config = AircraftConfig("uav1");
    config.Accept[0].From = {"ground"};
    SimulatedNode &uav = fleet.Add(config);
    uav.AddIdleManager("MissionControl");
    SimulatedNode &ground = fleet.Add(GroundConfig());
    SimulatedNode &other = fleet.Add(AircraftConfig("uav2"));
    fleet.RunFor(2s);
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
    EXPECT_FALSE(other.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
    fleet.RunFor(2s);
    EXPECT_EQ(ground.LinkTo("uav1", "MissionControl").delivered, 1u);
    EXPECT_THAT(
        other.Problems(),
        HasSubstr("queue `MissionControl` of uav1 accepts no messages of this node, but of `ground`"));
}

}  // namespace
}  // namespace Rabit
