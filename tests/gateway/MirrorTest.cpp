// Mirrored messages and presence: whole nodes on the simulated network.
#include <gmock/gmock.h>
#include <unistd.h>

#include <limits>
#include <string>

#include "HandNode.h"
#include "SimulatedFleet.h"
#include "names/TypeDefinition.h"
#include "presence/Whereabouts.h"
#include "wire/BeatNews.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class MirrorTest : public ::testing::Test
{
protected:
    // Runs until both sides are up and matched.
    void Settle() { fleet.RunFor(3s); }

    SimulatedFleet fleet;
};

TEST_F(MirrorTest, APostAppearsAtTheOtherNodeUnderTheOriginsName)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    pose->latitude_deg = 49.25;
    pose->yaw_rad = -0.5F;
    pose->PostMessage();
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 1s));
    EXPECT_TRUE(*mirrored == *pose);
}

TEST_F(MirrorTest, ANodeIsLostAfterTheTimeThatTheConfigurationStates)
{
    fleet.Add(AircraftConfig("uav1"));
    GatewayConfig config = GroundConfig();
    config.LostAfter = 10s;
    SimulatedNode &patient = fleet.Add(config);
    config.Node = "ground2";
    config.LostAfter = 1500ms;
    SimulatedNode &quick = fleet.Add(config);
    Settle();
    SimulatedFaults cut;
    cut.Cut = true;
    fleet.Network.SetFaults("uav1", "*", cut);
    EXPECT_TRUE(fleet.RunUntil([&] { return quick.StateOf("uav1") == "LOST"; }, 3s));
    fleet.RunFor(6s);
    EXPECT_EQ(patient.StateOf("uav1"), "STALE");
    EXPECT_TRUE(fleet.RunUntil([&] { return patient.StateOf("uav1") == "LOST"; }, 3s));
}

TEST_F(MirrorTest, AManagerIsWokenByAMirroredMessageAsByALocalOne)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    IdleManager &manager = ground.AddIdleManager("Listener");
    manager.SetWakeupTimeDelaySec(3600);
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = std::make_shared<Uav::Pose>();
    manager.AddPublishSubscribeMessage("uav1/Pose", mirrored);
    manager.WakeUpManagerOnMessagePost(mirrored);
    Settle();
    const int before = manager.Passes;
    pose->PostMessage();
    fleet.RunFor(100ms);
    EXPECT_EQ(manager.Passes, before + 1);
}

TEST_F(MirrorTest, TheTimeStampIsTheOrigins)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"), 1.2e9);
    SimulatedNode &ground = fleet.Add(GroundConfig(), 1.4e9);
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    pose->PostMessage();
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 1s));
    EXPECT_NEAR(mirrored->GetTimeStamp(), pose->GetTimeStamp(), 1e-6);
}

TEST_F(MirrorTest, TheAgeCountsFromThePostAtTheOriginHoweverWrongItsClockIs)
{
    SimulatedFaults slow;
    slow.Delay = 30ms;
    fleet.Network.SetFaults("*", "*", slow);
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"), 0.9e9);
    SimulatedNode &ground = fleet.Add(GroundConfig(), 1.4e9);
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    pose->PostMessage();
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 1s));
    EXPECT_NEAR(mirrored->GetAgeSeconds(), 0.030, 0.002);
    fleet.RunFor(2s);
    EXPECT_NEAR(mirrored->GetAgeSeconds(), 2.030, 0.002);
}

TEST_F(MirrorTest, TheAgeStaysRightWhenTheOriginsClockIsSet)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    uav.Clock->SetGpsTimeSeconds(1.4e9 - 3600.0);
    fleet.RunFor(1s);
    pose->PostMessage();
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 1s));
    EXPECT_LT(mirrored->GetAgeSeconds(), 0.01);
}

TEST_F(MirrorTest, AnOldStateDoesNotLookNewWhenTheOriginsClockIsSetBack)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    auto state = uav.Register<Uav::MissionState>("MissionState");
    state->PostMessage();
    fleet.RunFor(60s);
    uav.Clock->SetGpsTimeSeconds(1.4e9 - 3600.0);
    fleet.RunFor(2s);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto mirrored = ground.Register<Uav::MissionState>("uav1/MissionState");
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 5s));
    EXPECT_GT(mirrored->GetAgeSeconds(), 61.9);
}

TEST_F(MirrorTest, AValueOnItsWayDoesNotLookNewWhenTheOriginsClockIsSetBack)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    SimulatedFaults slow;
    slow.Delay = 20s;
    fleet.Network.SetFaults("uav1", "ground", slow);
    pose->PostMessage();
    fleet.RunFor(1ms);
    fleet.Network.ClearFaults();
    uav.Clock->SetGpsTimeSeconds(uav.Clock->GpsTimeSeconds() - 15.0);
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 30s));
    EXPECT_NEAR(mirrored->GetAgeSeconds(), 20.0, 0.01);
}

TEST_F(MirrorTest, AValueFromBeforeAPartitionDoesNotReplaceANewerOne)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    SimulatedFaults slow;
    slow.Delay = 30s;
    fleet.Network.SetFaults("uav1", "ground", slow);
    pose->number = 1;
    pose->PostMessage();
    fleet.RunFor(1ms);
    fleet.Network.ClearFaults();
    pose->number = 2;
    pose->PostMessage();
    fleet.RunFor(1s);
    mirrored->FetchMessage();
    ASSERT_EQ(mirrored->number, 2u);
    SimulatedFaults cut;
    cut.Cut = true;
    fleet.Network.SetFaults("uav1", "ground", cut);
    fleet.RunFor(10s);
    fleet.Network.ClearFaults();
    fleet.RunFor(30s);
    mirrored->FetchMessage();
    EXPECT_EQ(mirrored->number, 2u);
}

TEST_F(MirrorTest, AfterItsClockWasSetTheTimeStampOfAnOriginFollows)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    uav.Clock->SetGpsTimeSeconds(1.3e9);
    fleet.RunFor(1s);
    pose->PostMessage();
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 1s));
    EXPECT_NEAR(mirrored->GetTimeStamp(), pose->GetTimeStamp(), 1e-6);
}

TEST_F(MirrorTest, AStateReachesALateJoinerWithItsTrueAge)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    auto state = uav.Register<Uav::MissionState>("MissionState");
    state->commands = 17;
    state->PostMessage();
    fleet.RunFor(60s);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto mirrored = ground.Register<Uav::MissionState>("uav1/MissionState");
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 5s));
    EXPECT_EQ(mirrored->commands, 17u);
    EXPECT_GT(mirrored->GetAgeSeconds(), 59.9);
}

TEST_F(MirrorTest, TelemetryFromBeforeIsNotShownToALateJoiner)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    auto pose = uav.Register<Uav::Pose>("Pose");
    fleet.RunFor(1s);
    pose->PostMessage();
    fleet.RunFor(10s);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    fleet.RunFor(10s);
    EXPECT_FALSE(mirrored->FetchMessage() && mirrored->WasPosted());
}

TEST_F(MirrorTest, ARepeatedStateIsPostedOnce)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto state = uav.Register<Uav::MissionState>("MissionState");
    Settle();
    state->PostMessage();
    fleet.RunFor(20s);
    EXPECT_EQ(ground.Workspace.FindGlobalMessage("uav1/MissionState")->GetNumberOfPosts(), 1u);
    // A second post with the same contents is new.
    state->PostMessage();
    fleet.RunFor(20s);
    EXPECT_EQ(ground.Workspace.FindGlobalMessage("uav1/MissionState")->GetNumberOfPosts(), 2u);
}

TEST_F(MirrorTest, AStateGetsThroughALossyNetwork)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    SimulatedFaults lossy;
    lossy.Loss = 0.4;
    fleet.Network.SetFaults("*", "*", lossy);
    auto state = uav.Register<Uav::MissionState>("MissionState");
    auto mirrored = ground.Register<Uav::MissionState>("uav1/MissionState");
    fleet.RunFor(10s);
    for (std::uint32_t i = 1; i <= 20; ++i)
    {
        state->commands = i;
        state->PostMessage();
        EXPECT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage() && mirrored->commands == i; }, 10s))
            << i;
    }
}

TEST_F(MirrorTest, MaxRateSkipsValuesButNotTheLastOne)
{
    GatewayConfig config = AircraftConfig("uav1");
    config.Publish[0].MaxRate = 5;
    SimulatedNode &uav = fleet.Add(config);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    for (int i = 1; i <= 100; ++i)
    {
        pose->latitude_deg = i * 0.01;
        pose->PostMessage();
        fleet.RunFor(10ms);
    }
    fleet.RunFor(1s);
    const std::uint64_t posts = ground.Workspace.FindGlobalMessage("uav1/Pose")->GetNumberOfPosts();
    EXPECT_GE(posts, 5u);
    EXPECT_LE(posts, 7u);
    mirrored->FetchMessage();
    EXPECT_DOUBLE_EQ(mirrored->latitude_deg, 1.0);
}

TEST_F(MirrorTest, AMirroredMessageIsNotMirroredAgain)
{
    // Both nodes want and publish Pose: there would be a loop if mirrored messages went out again.
    GatewayConfig first = AircraftConfig("uav1");
    first.Subscribe.push_back({.Message = "Pose", .Type = "Uav::Pose"});
    GatewayConfig second = AircraftConfig("uav2");
    second.Subscribe.push_back({.Message = "Pose", .Type = "Uav::Pose"});
    SimulatedNode &uav1 = fleet.Add(first);
    SimulatedNode &uav2 = fleet.Add(second);
    auto pose = uav1.Register<Uav::Pose>("Pose");
    Settle();
    pose->PostMessage();
    fleet.RunFor(5s);
    EXPECT_EQ(uav2.Workspace.FindGlobalMessage("uav1/Pose")->GetNumberOfPosts(), 1u);
    EXPECT_EQ(uav2.Workspace.FindGlobalMessage("Pose")->GetNumberOfPosts(), 0u);
    EXPECT_EQ(uav1.Workspace.FindGlobalMessage("uav2/Pose"), nullptr);
}

TEST_F(MirrorTest, AKilledNodeIsStaleThenLostWithinFiveSecondsAndUpAgainWhenItReturns)
{
    fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    Settle();
    EXPECT_EQ(ground.StateOf("uav1"), "UP");
    fleet.Kill("uav1");
    EXPECT_TRUE(fleet.RunUntil([&] { return ground.StateOf("uav1") == "STALE"; }, 2500ms));
    EXPECT_TRUE(fleet.RunUntil([&] { return ground.StateOf("uav1") == "LOST"; }, 2500ms));

    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    EXPECT_TRUE(fleet.RunUntil([&] { return ground.StateOf("uav1") == "UP"; }, 5s));
    fleet.RunFor(2s);
    pose->PostMessage();
    EXPECT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 1s));
}

TEST_F(MirrorTest, ANodeThatEndsInOrderIsLostAtOnce)
{
    fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    Settle();
    fleet.Stop("uav1");
    EXPECT_TRUE(fleet.RunUntil([&] { return ground.StateOf("uav1") == "LOST"; }, 1s));
    EXPECT_EQ(ground.Fleet().nodes.at(0).reason, "left");
}

TEST_F(MirrorTest, APartitionIsShownAndHeals)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    SimulatedFaults cut;
    cut.Cut = true;
    fleet.Network.SetFaults("uav1", "ground", cut);
    EXPECT_TRUE(fleet.RunUntil([&] { return ground.StateOf("uav1") == "LOST"; }, 5s));
    fleet.RunFor(30s);
    fleet.Network.ClearFaults();
    // The transport has given the peer up, too, and announces itself once in 10 s.
    EXPECT_TRUE(fleet.RunUntil([&] { return ground.StateOf("uav1") == "UP"; }, 15s));
    fleet.RunFor(3s);
    pose->PostMessage();
    EXPECT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 1s));
}

TEST_F(MirrorTest, TheRoundTripIsMeasured)
{
    SimulatedFaults slow;
    slow.Delay = 25ms;
    fleet.Network.SetFaults("*", "*", slow);
    fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    Settle();
    EXPECT_NEAR(ground.Fleet().nodes.at(0).round_trip_s, 0.050, 0.001);
}

TEST_F(MirrorTest, TwoNodesOfOneNameAreReportedByBothAndByOthers)
{
    SimulatedNode &ground = fleet.Add(GroundConfig());
    SimulatedNode &first = fleet.Add(AircraftConfig("uav1"));
    SimulatedNode &second = fleet.Add(AircraftConfig("uav1"), 1.5e9, "second");
    fleet.RunFor(10s);
    EXPECT_THAT(first.Problems(), HasSubstr("node uav1: another live node has the name of this one"));
    EXPECT_THAT(second.Problems(), HasSubstr("node uav1: another live node has the name of this one"));
    EXPECT_THAT(ground.Problems(), HasSubstr("node uav1: two live nodes have this name"));

    // All nodes of this test are in one process.
    const std::string place = Whereabouts::OfThisProcess();
    EXPECT_THAT(place, HasSubstr(", process " + std::to_string(::getpid())));
    const std::string both = "this one is on " + place + ", the other on " + place;
    EXPECT_THAT(first.Problems(), HasSubstr(both));
    EXPECT_THAT(second.Problems(), HasSubstr(both));
    EXPECT_THAT(ground.Problems(), HasSubstr("; both are on " + place));
}

TEST_F(MirrorTest, WhyNoDataComesIsSaidByNameWithinTwoSeconds)
{
    GatewayConfig config = AircraftConfig("uav1");
    config.Publish.erase(config.Publish.begin());
    fleet.Add(config);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    EXPECT_TRUE(fleet.RunUntil(
        [&]
        {
            return ground.Problems().find(
                       "subscribe Pose: uav1 does not publish `Pose`; it publishes `MissionState`") !=
                   std::string::npos;
        },
        2s))
        << ground.Problems();
}

TEST_F(MirrorTest, WhoAsksForAStateTakesNoTelemetryAndIsToldOnce)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    GatewayConfig config = GroundConfig();
    config.Subscribe[0].Qos = QosProfile::State;
    SimulatedNode &ground = fleet.Add(config);
    auto pose = uav.Register<Uav::Pose>("Pose");
    auto mirrored = ground.Register<Uav::Pose>("uav1/Pose");
    Settle();
    pose->PostMessage();
    fleet.RunFor(5s);
    EXPECT_FALSE(mirrored->FetchMessage() && mirrored->WasPosted());
    const std::string problem =
        "subscribe Pose: uav1 publishes `Pose` with qos telemetry, this node wants qos state\n";
    const std::string problems = ground.Problems();
    const std::size_t at = problems.find(problem);
    ASSERT_NE(at, std::string::npos) << problems;
    EXPECT_EQ(problems.find("subscribe Pose", at + 1), std::string::npos) << problems;
}

TEST_F(MirrorTest, WhoAsksForTelemetryTakesAState)
{
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    GatewayConfig config = GroundConfig();
    config.Subscribe[1].Qos = QosProfile::Telemetry;
    SimulatedNode &ground = fleet.Add(config);
    auto state = uav.Register<Uav::MissionState>("MissionState");
    auto mirrored = ground.Register<Uav::MissionState>("uav1/MissionState");
    Settle();
    state->commands = 3;
    state->PostMessage();
    ASSERT_TRUE(fleet.RunUntil([&] { return mirrored->FetchMessage(); }, 2s));
    EXPECT_EQ(mirrored->commands, 3u);
}

TEST_F(MirrorTest, ALocalMessageOfAnotherTypeIsReportedNotOverwritten)
{
    SimulatedNode &ground = fleet.Add(GroundConfig());
    ground.Register<Uav::Goto>("uav1/Pose");
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    auto pose = uav.Register<Uav::Pose>("Pose");
    Settle();
    pose->PostMessage();
    fleet.RunFor(2s);
    EXPECT_THAT(
        ground.Problems(),
        HasSubstr("subscribe Pose: the local message `uav1/Pose` is of another type than `Uav::Pose`"));
}

// A node whose announcements and poses are written by the test.
class RogueNode
{
public:
    RogueNode(SimulatedNetwork &network, const std::string &node) : _node(network, node, 42)
    {
        TopicQos qos;
        qos.Durability = Durability::TransientLocal;
        _poses = _node.Session().CreateWriter({"Pose", "Uav::Pose", {}}, qos, {"", node});
    }

    void SendBeat()
    {
        Gateway::Announcement announcement;
        Gateway::PublishedMessage &pose = announcement.publishes.emplace_back();
        pose.message = "Pose";
        pose.type = "Uav::Pose";
        pose.qos = "telemetry";
        pose.definition = DefinitionHash(Uav::Pose::IdlType());
        Gateway::Beat beat = _node.Beat();
        Announce(beat, announcement);
        _node.Write(beat);
    }

    HandNode &Node() { return _node; }
    void SendPose(const SampleEncoder &pose) { EXPECT_EQ(_poses->Write(pose, 0), WriteResult::Ok); }
    void SendPoseBytes(const std::vector<std::uint8_t> &bytes) { SendPose(HandNode::Bytes(bytes)); }

private:
    HandNode _node;
    std::unique_ptr<TransportWriter> _poses;
};

TEST_F(MirrorTest, ASampleThatDoesNotDecodeIsDroppedAndCountedByTopicAndSource)
{
    SimulatedNode &ground = fleet.Add(GroundConfig());
    RogueNode rogue(fleet.Network, "uav9");
    fleet.RunFor(1s);
    for (int i = 1; i <= 4; ++i)
    {
        rogue.SendBeat();
        fleet.RunFor(500ms);
    }
    rogue.SendPoseBytes({0, 1, 0, 0, 1, 2, 3});
    rogue.SendPoseBytes({0, 1, 0, 0});
    fleet.RunFor(1s);
    ASSERT_EQ(ground.Fleet().topics.size(), 1u);
    EXPECT_EQ(ground.Fleet().topics[0].message, "Pose");
    EXPECT_EQ(ground.Fleet().topics[0].node, "uav9");
    EXPECT_EQ(ground.Fleet().topics[0].undecodable, 2u);
    EXPECT_EQ(ground.Fleet().topics[0].received, 0u);
    ASSERT_EQ(ground.Fleet().nodes.size(), 1u);
    EXPECT_EQ(ground.Fleet().nodes[0].undecodable, 2u);
}

TEST_F(MirrorTest, SamplesOfANodeThatIsNotHeardAreNotPosted)
{
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto mirrored = ground.Register<Uav::Pose>("uav9/Pose");
    GatewayConfig aircraft = AircraftConfig("uav1");  // so that the ground reads the topic at all
    fleet.Add(aircraft);
    RogueNode rogue(fleet.Network, "uav9");
    Settle();
    const Uav::Pose pose;
    rogue.SendPose(MessageSample(pose));
    fleet.RunFor(1s);
    EXPECT_FALSE(mirrored->FetchMessage() && mirrored->WasPosted());
    EXPECT_EQ(ground.Fleet().topics.at(0).refused, 1u);
}

TEST_F(MirrorTest, GarbledGatewayTrafficIsCountedAndChangesNothing)
{
    SimulatedNode &ground = fleet.Add(GroundConfig());
    fleet.Add(AircraftConfig("uav1"));
    HandNode rogue(fleet.Network, "uav9", 42);
    Settle();
    Gateway::Beat beat = rogue.Beat();
    beat.source_ns = std::numeric_limits<std::int64_t>::min();
    rogue.Write(beat);
    beat = rogue.Beat();
    NewsOf(beat).first_state = 60000;
    rogue.Write(beat);
    const auto format = static_cast<std::uint8_t>(BeatFormat::Present & 0xff);
    rogue.WriteBytes({0, 1, 0, 0, format, BeatFormat::Present >> 8, 9, 9, 9});
    fleet.RunFor(1500ms);
    EXPECT_EQ(ground.Fleet().malformed, 3u);
    EXPECT_EQ(ground.Fleet().nodes.size(), 1u);
    EXPECT_EQ(ground.StateOf("uav1"), "UP");
}

}  // namespace
}  // namespace Rabit
