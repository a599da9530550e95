// Samples of the gateways' topics in another node's name: whole nodes on the simulated network.
#include <gmock/gmock.h>
#include <rabit/gateway/links/LinkCheck.h>
#include <rabit/gateway/links/LinkFrameCodec.h>

#include "MessageSample.h"
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
    ImpostorTest() : uav(fleet.Add(AircraftConfig("uav1"))), ground(fleet.Add(GroundConfig()))
    {
        TransportSettings settings;
        settings.Node = "uav9";
        settings.Incarnation = 7;
        impostor = SimulatedTransport(fleet.Network).Open(settings, [](const PeerEvent &) {});
        fleet.RunFor(2s);
    }

    // What uav9 writes to a topic of the gateways.
    template <typename Sample>
    void Write(const char *topic, const Sample &sample, const std::string &partition, Reliability reliability)
    {
        TopicQos qos;
        qos.Reliability = reliability;
        const auto writer =
            impostor->CreateWriter({topic, MessageTypeRegistry::Of(sample)->Name(), {}}, qos, {partition});
        fleet.RunFor(1s);
        EXPECT_EQ(writer->Write(MessageSample(sample), 0), WriteResult::Ok);
        fleet.RunFor(1s);
    }

    SimulatedFleet fleet;
    SimulatedNode &uav;
    SimulatedNode &ground;
    std::unique_ptr<TransportSession> impostor;
};

constexpr const char *Complaint = "node `uav9` sends in the name of `ground`; it is not listened to";

TEST_F(ImpostorTest, ABeatInAnothersNameIsNotBelieved)
{
    const std::uint64_t before = uav.Fleet().malformed;
    Gateway::Beat beat;
    beat.node = "ground";
    beat.incarnation = ground.Fleet().incarnation + (1ULL << 32);
    beat.monotonic_ns = beat.source_ns = beat.utc_ns = 1;
    Write("rabit/Beat", beat, "", Reliability::BestEffort);
    EXPECT_THAT(uav.Problems(), HasSubstr(Complaint));
    EXPECT_EQ(uav.Fleet().malformed, before + 1);
    ASSERT_EQ(uav.Fleet().nodes.size(), 1u);
    EXPECT_EQ(uav.Fleet().nodes[0].incarnation, ground.Fleet().incarnation);
}

TEST_F(ImpostorTest, AGoodbyeInAnothersNameIsNotBelieved)
{
    Gateway::Announcement goodbye;
    goodbye.node = "ground";
    goodbye.incarnation = ground.Fleet().incarnation;
    goodbye.leaving = true;
    TopicQos qos;
    qos.Durability = Durability::TransientLocal;
    const auto writer =
        impostor->CreateWriter({"rabit/Announcement", "Rabit::Gateway::Announcement", {}}, qos, {});
    writer->Write(MessageSample(goodbye), 0);
    fleet.RunFor(1s);
    EXPECT_THAT(uav.Problems(), HasSubstr(Complaint));
    EXPECT_EQ(uav.StateOf("ground"), "UP");
}

// Frames of the links name no sender: it is who DDS says wrote them.
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
        const auto writer =
            session->CreateWriter({"rabit/Link", "Rabit::Gateway::LinkSample", {}}, qos, {});
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
    EXPECT_THAT(uav.Problems(), HasSubstr("speaks version 7 of the queue links, this one version 3"));
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
