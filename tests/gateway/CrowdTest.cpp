// A node that hears of more names than it remembers.
#include <gmock/gmock.h>
#include <rabit/gateway/links/LinkCheck.h>
#include <rabit/gateway/links/LinkFrameCodec.h>

#include "HandNode.h"
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
        HandNode node(fleet.Network, std::string("n").append(std::to_string(i)), Life);
        TopicQos qos;
        qos.Reliability = Reliability::BestEffort;
        const auto hellos =
            node.Session().CreateWriter({"rabit/Link", "Rabit::Gateway::LinkSample", {}}, qos, {});
        ASSERT_TRUE(fleet.RunUntil([&] { return node.IsHeard() && hellos->MatchedReaders() > 0; }, 20s));
        node.Write(node.Beat());
        LinkFrame hello;
        hello.Check = LinkCheck::OfName("uav1");
        hello.SenderLife = Life;
        hello.Clock = 1;
        Gateway::LinkSample sample;
        sample.frame.resize(LinkFrameCodec::EncodedSize(hello));
        LinkFrameCodec::Encode(hello, sample.frame);
        hellos->Write(MessageSample(sample), 1);
        fleet.RunFor(5ms);
    }

    static constexpr std::uint64_t Life = 7ULL << 32;

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
    EXPECT_EQ(uav.Fleet().crowded_out, 0u);
}

}  // namespace
}  // namespace Rabit
