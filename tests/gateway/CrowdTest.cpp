// A node that has heard more names than it remembers.
#include <gmock/gmock.h>
#include <rabit/gateway/links/LinkCheck.h>
#include <rabit/gateway/links/LinkFrameCodec.h>

#include "MessageSample.h"
#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

// Nodes that appear for a moment, one after the other: each beats once, and says hello to uav1.
class CrowdTest : public ::testing::Test
{
protected:
    void Pass(int i)
    {
        TransportSettings settings;
        settings.Node = std::string("n").append(std::to_string(i));
        settings.Incarnation = 7ULL << 32;
        const auto session = SimulatedTransport(fleet.Network).Open(settings, [](const PeerEvent &) {});
        TopicQos qos;
        qos.Reliability = Reliability::BestEffort;
        const auto beats = session->CreateWriter({"rabit/Beat", "Rabit::Gateway::Beat", {}}, qos, {});
        const auto hellos =
            session->CreateWriter({"rabit/Link", "Rabit::Gateway::LinkSample", {}}, qos, {});
        fleet.RunFor(20ms);
        Gateway::Beat beat;
        beat.node = settings.Node;
        beat.incarnation = settings.Incarnation;
        beat.monotonic_ns = beat.source_ns = beat.utc_ns = 1;
        beats->Write(MessageSample(beat), 1);
        LinkFrame hello;
        hello.Check = LinkCheck::OfName("uav1");
        hello.SenderLife = settings.Incarnation;
        hello.Clock = 1;
        Gateway::LinkSample sample;
        sample.frame.resize(LinkFrameCodec::EncodedSize(hello));
        LinkFrameCodec::Encode(hello, sample.frame);
        hellos->Write(MessageSample(sample), 1);
        fleet.RunFor(5ms);
    }

    SimulatedFleet fleet;
};

TEST_F(CrowdTest, DoesNotKeepANodeFromSendingAndReceivingAfterwards)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    for (int i = 0; i < 1100; ++i)
    {
        Pass(i);
    }
    SimulatedNode &ground = fleet.Add(GroundConfig());
    IdleManager &commands = ground.AddIdleManager("Commands");
    fleet.RunFor(2s);
    EXPECT_TRUE(uav.Workspace.AddMessageToQueue("ground/Commands", std::make_shared<Uav::CommandAck>()));
    fleet.RunFor(2s);
    EXPECT_EQ(commands.GetManagerMessageQueue()->NoMessagesInQueue(), 1u);
    EXPECT_EQ(uav.StateOf("ground"), "UP");
    EXPECT_LE(uav.Fleet().nodes.size(), 1000u);
    EXPECT_EQ(uav.Fleet().forgotten, 101u);
    // For a node that was not heard yet nobody is forgotten: ground's announcement came before its beat.
    EXPECT_EQ(uav.Fleet().crowded_out, 1u);
}

}  // namespace
}  // namespace Rabit
