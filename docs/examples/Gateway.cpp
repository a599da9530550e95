// A gateway made by hand, its configuration in code, and what a tool sees through it.
#include <gtest/gtest.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/AirCost.h>
#include <rabit/gateway/ByteSize.h>
#include <rabit/gateway/CheckTransportSettings.h>
#include <rabit/gateway/ClassRates.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/FleetExplorer.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/gateway/GatewayTap.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/PanelRule.h>
#include <rabit/gateway/PresenceTraffic.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/gateway/RandomSource.h>
#include <rabit/gateway/SchemaText.h>
#include <rabit/gateway/TrafficClass.h>
#include <rabit/testing/SimulatedFleet.h>
#include <rabit/transport/TransportFactory.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "uav.idl.h"

namespace
{

using namespace std::chrono_literals;

// [config]
Rabit::GatewayConfig ConfigInCode()
{
    Rabit::GatewayConfig config;
    config.Node = "uav1";
    config.Domain = 7;
    config.Interfaces = {"lo"};
    config.Radio.Budget = 5000;  // bytes a second
    config.Publish.push_back({.Message = "Pose",
                              .Type = "Uav::Pose",
                              .Qos = Rabit::QosProfile::Telemetry,
                              .MaxRate = 10,
                              .Class = Rabit::TrafficClass::Telemetry});
    config.Accept.push_back({.Queue = "Mission", .Types = {"Uav::Goto"}, .From = {"ground"}});
    config.Send.push_back({.Queue = "Mission", .Expire = 5s});
    return config;
}
// [/config]

// [gateway]
// Without RunNode: managers and a gateway in one reactor.
void RunByHand(const Rabit::GatewayConfig &config)
{
    Rabit::RabitReactor reactor;
    reactor.AddManager(
        std::make_unique<Rabit::GatewayManager>(config, Rabit::MakeTransport(config.Transport)));
    reactor.Run();
}
// [/gateway]

TEST(GatewayExample, AConfigurationInCodeIsCheckedLikeAFile)
{
    Rabit::GatewayConfig config = ConfigInCode();
    EXPECT_NO_THROW(Rabit::ValidateGatewayConfig(config));
    config.Publish.push_back(config.Publish.front());
    EXPECT_THROW(Rabit::ValidateGatewayConfig(config), Rabit::ConfigError);
    EXPECT_THROW(RunByHand(config), Rabit::ConfigError);  // before anything starts
}

// [errors]
TEST(GatewayExample, AnErrorOfAFileIsOneLine)
{
    const std::string file = ::testing::TempDir() + "rabit-gateway-" + std::to_string(::getpid()) + ".yaml";
    std::ofstream(file) << "node: uav1\ndomian: 7\n";
    try
    {
        Rabit::LoadGatewayConfig(file);
        FAIL();
    }
    catch (const Rabit::JoinError &error)  // of a gateway: no such interface, for instance
    {
        FAIL() << error.Setting();
    }
    catch (const Rabit::ConfigError &error)
    {
        EXPECT_EQ(error.what(),
                  file + ":2: unknown key `domian` in the configuration; did you mean `domain`?");
    }
    std::filesystem::remove(file);
}
// [/errors]

// [check]
TEST(GatewayExample, SettingsOfTheNetworkAreCheckedWithoutJoiningIt)
{
    Rabit::GatewayConfig config = ConfigInCode();
    config.Interfaces = {"wlan99"};
    const auto transport = Rabit::MakeTransport(Rabit::AvailableTransports().front());
    EXPECT_EQ(Rabit::CheckTransportSettings(config, *transport).size(), 1u);  // it may yet come
}
// [/check]

// [explorer]
TEST(GatewayExample, AToolAsksForWhatNodesAnnounce)
{
    Rabit::SimulatedFleet fleet;
    Rabit::GatewayConfig uav = ConfigInCode();
    uav.Domain = 0;
    uav.Radio.Budget.reset();
    fleet.Add(uav);
    Rabit::GatewayConfig config;
    config.Node = "laptop";
    config.Tool.emplace();
    Rabit::FleetExplorer &explorer = fleet.Add(config).Manager->Explorer();
    fleet.RunFor(5s);

    const std::vector<Rabit::FleetExplorer::Node> nodes = explorer.Nodes();
    ASSERT_EQ(nodes.size(), 1u);
    ASSERT_TRUE(nodes[0].Offers);
    EXPECT_EQ(nodes[0].Offers->publishes.at(0).message, "Pose");
}
// [/explorer]

TEST(GatewayExample, AToolReadsTheReportOnForeignTopics)
{
    const auto topics = Rabit::FleetExplorer::ForeignTopicsIn(
        "read\tUP\trt/chatter\tString_\tChatter\tbest effort\t7\t1\t\nany other line\n");
    ASSERT_EQ(topics.size(), 1u);
    EXPECT_EQ(topics[0].topic, "rt/chatter");
    EXPECT_EQ(topics[0].samples, 7u);
}

// [tap]
// Sees each queue message of a gateway, for instance to record it.
class Tap : public Rabit::GatewayTap
{
public:
    void Sent(const QueueMessage &message) override { SentTo.emplace_back(message.Queue); }
    void Refused(const QueueMessage &, std::string_view) override {}
    void Settled(std::string_view, std::string_view, std::uint64_t, Rabit::QueueOutcome outcome) override
    {
        Outcomes.push_back(outcome);
    }
    void Received(const QueueMessage &) override {}
    void Mirrored(const MirroredSample &) override {}
    void Clocks(std::uint64_t, std::chrono::nanoseconds, const std::vector<PeerClock> &) override {}
    std::vector<Rabit::Gateway::Problem> Problems() override { return {}; }

    std::vector<std::string> SentTo;
    std::vector<Rabit::QueueOutcome> Outcomes;
};

TEST(GatewayExample, ATapSeesMessagesAndTheirOutcomes)
{
    Rabit::SimulatedFleet fleet;
    Rabit::GatewayConfig uav;
    uav.Node = "uav1";
    uav.Accept.push_back({.Queue = "Mission", .Types = {"Uav::GoHome"}});
    fleet.Add(uav,
              [](Rabit::SimulatedNode &node, Rabit::GatewayConfig &) { node.AddIdleManager("Mission"); });
    Rabit::GatewayConfig config;
    config.Node = "ground";
    const auto tap = std::make_shared<Tap>();
    config.Tap = tap;
    Rabit::SimulatedNode &ground = fleet.Add(config);
    fleet.RunFor(3s);
    ground.Workspace.AddMessageToQueue("uav1/Mission", std::make_shared<Uav::GoHome>());
    fleet.RunFor(2s);
    EXPECT_EQ(tap->SentTo, std::vector<std::string>{"Mission"});
    EXPECT_EQ(tap->Outcomes, std::vector<Rabit::QueueOutcome>{Rabit::QueueOutcome::Delivered});
}
// [/tap]

// [rates]
TEST(GatewayExample, TheRateOfEachClassIsInTheFleetMessage)
{
    Rabit::SimulatedFleet fleet;
    Rabit::GatewayConfig config;
    config.Node = "uav1";
    fleet.Add(config);
    fleet.RunFor(5s);
    const Rabit::Gateway::AirStatus air = fleet["uav1"].Fleet().air;
    for (const Rabit::ClassRate &rate : Rabit::ClassRates)
    {
        EXPECT_GE(air.*rate.Value, 0) << rate.Name;  // bytes a second
    }
}
// [/rates]

// [cost]
TEST(GatewayExample, ASampleCostsItsHeadersToo)
{
    const Rabit::AirCost cost(1400);  // bytes of the largest datagram, as `max_datagram`
    EXPECT_EQ(cost.Of(100), 188u);    // IPv4 and UDP 28, RTPS 20, time stamp 12, data 24, encapsulation 4
    EXPECT_EQ(cost.BodyWithin(188, false), 100u);
}
// [/cost]

// [presence]
TEST(GatewayExample, AToolPlansThePresenceOfANode)
{
    Rabit::GatewayConfig config;
    config.Node = "uav1";
    const Rabit::PresenceTraffic presence = Rabit::PresenceTrafficOf(config, 1);
    EXPECT_EQ(presence.BeatBytes, 108u);
    EXPECT_EQ(presence.BeatPeriod, 500ms);
    EXPECT_EQ(presence.AnnouncementPeriod, 10s);
    config.Radio.Budget = 2560;  // bytes a second
    EXPECT_EQ(Rabit::PresenceTrafficOf(config, 1).AnnouncementPeriod, 30s);
}
// [/presence]

// [panel]
TEST(GatewayExample, AViewerShowsAMessageOnItsMap)
{
    Rabit::PanelRule rule;
    rule.Message = "Pose";
    rule.Schema = Rabit::PanelRule::Panel::LocationFix;
    rule.Fields = {{"latitude", "latitude_deg"}, {"longitude", "longitude_deg"}};
    Rabit::GatewayConfig config = ConfigInCode();
    config.Panels.push_back(rule);
    EXPECT_NO_THROW(Rabit::ValidateGatewayConfig(config));
}
// [/panel]

// [words]
TEST(GatewayExample, AToolReadsTheWordsOfConfigurations)
{
    EXPECT_TRUE(Rabit::IsNodeName("uav1"));
    EXPECT_TRUE(Rabit::IsMessageName("uav1/Pose"));
    EXPECT_TRUE(Rabit::MatchesPattern("uav*", "uav1"));
    EXPECT_FALSE(Rabit::CoversPattern("uav?", "uav*"));
    EXPECT_EQ(Rabit::ProfileOf("telemetry"), Rabit::QosProfile::Telemetry);
    EXPECT_EQ(Rabit::ParseByteSize("64MB", Rabit::RecordRanges::Memory), 64'000'000u);
    EXPECT_THROW(Rabit::ParseByteSize("64", Rabit::RecordRanges::Memory), std::invalid_argument);
}
// [/words]

TEST(GatewayExample, AViewerReadsAMemberThatIsNamedAsAKeyword)
{
    EXPECT_EQ(Rabit::SchemaText("struct Label { string _String; };"), "struct Label { string String; };");
}

TEST(GatewayExample, ChanceComesFromTheSystemUnlessATestGivesIt)
{
    const Rabit::RandomSource random = Rabit::SystemRandom;
    EXPECT_NE(random(), random());
}

}  // namespace
