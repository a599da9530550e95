// Messages of types that this program was not built with, given as IDL texts: whole nodes on the simulated
// network.
#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/dynamic/DynamicType.h>

#include <gmock/gmock.h>

#include <vector>

#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr const char *Text = R"(module Late {
enum Kind { WALKED, SWAM };
@final struct Track { @key long id; Late::Kind kind; sequence<double> points; };
@final struct Order { @default(3) long number; string<20> words; };
};
)";

std::shared_ptr<const DynamicType> Known(const char *name)
{
    auto type = DynamicType::Parse(Text, name).Type;
    DynamicType::Register(type);
    return type;
}

class DynamicTypeTest : public ::testing::Test
{
protected:
    static GatewayConfig Sender()
    {
        GatewayConfig config;
        config.Node = "uav1";
        config.Publish.push_back({.Message = "Track", .Type = "Late::Track"});
        config.Accept.push_back({.Queue = "Orders", .Types = {"Late::Order"}});
        return config;
    }
    static GatewayConfig Receiver()
    {
        GatewayConfig config;
        config.Node = "ground";
        config.Subscribe.push_back({.Message = "Track", .Type = "Late::Track", .From = {"uav*"}});
        return config;
    }

    std::shared_ptr<const DynamicType> track = Known("Late::Track");
    std::shared_ptr<const DynamicType> order = Known("Late::Order");
    SimulatedFleet fleet;
};

TEST_F(DynamicTypeTest, IsPublishedAndMirrored)
{
    SimulatedNode &uav = fleet.Add(Sender());
    SimulatedNode &ground = fleet.Add(Receiver());
    auto posted = std::make_shared<DynamicMessage>(track);
    auto mirrored = std::make_shared<DynamicMessage>(track);
    ASSERT_TRUE(uav.Workspace.AddPublishSubscribeMessage("Track", posted));
    ASSERT_TRUE(ground.Workspace.AddPublishSubscribeMessage("uav1/Track", mirrored));
    fleet.RunFor(3s);
    ASSERT_EQ(posted->SetJson(R"({"id": 7, "kind": "SWAM", "points": [1.5, -2]})"), "");
    posted->PostMessage();
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 1s));
    EXPECT_EQ(mirrored->ToJson(), R"({"id":7,"kind":"SWAM","points":[1.5,-2]})");
}

TEST_F(DynamicTypeTest, IsReportedAndSendsNothingIfTheProgramHasAnotherUnderTheName)
{
    auto posted = std::make_shared<DynamicMessage>(order);
    SimulatedNode &uav =
        fleet.Add(Sender(), [&posted](SimulatedNode &node, GatewayConfig & /* config */)
                  { ASSERT_TRUE(node.Workspace.AddPublishSubscribeMessage("Track", posted)); });
    SimulatedNode &ground = fleet.Add(Receiver());
    auto mirrored = std::make_shared<DynamicMessage>(track);
    ASSERT_TRUE(ground.Workspace.AddPublishSubscribeMessage("uav1/Track", mirrored));
    fleet.RunFor(3s);
    posted->PostMessage();
    fleet.RunFor(1s);
    EXPECT_FALSE(mirrored->FetchMessage());
    EXPECT_THAT(uav.Problems(),
                HasSubstr("publish Track: the local message `Track` is of another type than `Late::Track`"));
}

TEST_F(DynamicTypeTest, IsNotAttachedUnderThePublishedNameOfAnother)
{
    SimulatedNode &uav = fleet.Add(Sender());
    EXPECT_FALSE(uav.Workspace.AddPublishSubscribeMessage("Track", std::make_shared<DynamicMessage>(order)));
}

TEST_F(DynamicTypeTest, IsSentToAQueue)
{
    SimulatedNode &uav = fleet.Add(Sender());
    IdleManager &orders = uav.AddIdleManager("Orders");
    SimulatedNode &ground = fleet.Add(Receiver());
    fleet.RunFor(2s);
    auto message = std::make_shared<DynamicMessage>(order);
    ASSERT_EQ(message->SetJson(R"({"words": "come home"})"), "");
    ASSERT_TRUE(ground.Workspace.AddMessageToQueue("uav1/Orders", std::shared_ptr<RabitMessage>(message)));
    fleet.RunFor(1s);
    std::shared_ptr<RabitMessage> arrived;
    ASSERT_TRUE(orders.GetManagerMessageQueue()->GetMessage(arrived));
    const auto taken = std::dynamic_pointer_cast<DynamicMessage>(arrived);
    ASSERT_TRUE(taken);
    EXPECT_EQ(taken->ToJson(), R"({"number":3,"words":"come home"})");
}

// A program with generated code and one without exchange the same bytes.
TEST_F(DynamicTypeTest, OfTheTextOfAGeneratedTypeReadsItsMessages)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    const MessageType &generated = Uav::Pose::IdlType();
    const auto type = DynamicType::Parse(generated.IdlText(), generated.Name()).Type;
    ASSERT_TRUE(type);
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    fleet.RunFor(3s);
    pose->latitude_deg = 49.25;
    pose->PostMessage();
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 1s));
    std::vector<std::uint8_t> sample(generated.SerializedSize(*mirrored));
    ASSERT_EQ(generated.Serialize(*mirrored, sample), sample.size());
    EXPECT_EQ(type->ToText(sample), mirrored->ToString());
}

}  // namespace
}  // namespace Rabit
