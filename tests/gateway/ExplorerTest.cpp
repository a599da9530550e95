// A program explores a fleet whose messages it was not built with: whole nodes on the simulated network.
#include <gmock/gmock.h>
#include <rabit/gateway/FleetExplorer.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <stdexcept>

#include "ForeignNetwork.h"
#include "HandNode.h"
#include "SimulatedFleet.h"
#include "manager/Exploration.h"
#include "names/TypeDefinition.h"
#include "wire/BeatExtensions.h"
#include "wire/LinkSampleCodec.h"
#include "wire/LinkTopics.h"
#include "wire/NodeReports.h"
#include "wire/TypeFrames.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::SizeIs;

std::uint64_t HashOf(const std::string &type)
{
    return DefinitionHash(*MessageTypeRegistry::Find(type));
}

class ExplorerTest : public ::testing::Test
{
protected:
    ExplorerTest() : uav(fleet.Add(AircraftConfig("uav1"))) { fleet.RunFor(3s); }

    // Adds a tool and returns its explorer.
    FleetExplorer &AddTool(const std::function<void(GatewayConfig &)> &change = {})
    {
        GatewayConfig config;
        config.Node = "tool";
        config.Tool.emplace();
        if (change)
        {
            change(config);
        }
        tool = &fleet.Add(config);
        return tool->Manager->Explorer();
    }

    bool Get(FleetExplorer &explorer, const std::string &type, std::chrono::nanoseconds limit = 10s)
    {
        explorer.AskForType("uav1", type, HashOf(type));
        return fleet.RunUntil([&] { return explorer.TypeText(HashOf(type)).has_value(); }, limit);
    }

    SimulatedFleet fleet;
    SimulatedNode &uav;
    SimulatedNode *tool = nullptr;
};

TEST_F(ExplorerTest, TellsWhatEachNodeAnnounces)
{
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(2s);
    ASSERT_THAT(explorer.Nodes(), SizeIs(1));
    const FleetExplorer::Node node = explorer.Nodes().front();
    EXPECT_EQ(node.Name, "uav1");
    EXPECT_EQ(node.State, Gateway::NodeState::UP);
    ASSERT_TRUE(node.Offers.has_value());
    EXPECT_EQ(node.Offers->publishes[0].message, "Pose");
    EXPECT_EQ(node.Offers->accepts[0].queue, "MissionControl");
}

TEST(Exploration, WhatWasPostedIsTakenByAUnitOfWorkThatBeginsLater)
{
    std::function<void()> onWake;
    Exploration exploration([&onWake] { onWake(); });
    const std::uint64_t begunBefore = exploration.BeginTurn();
    onWake = [&] { exploration.EndTurn(begunBefore); };
    EXPECT_FALSE(exploration.WaitUntilTaken(0s));
    onWake = [&] { exploration.EndTurn(exploration.BeginTurn()); };
    EXPECT_TRUE(exploration.WaitUntilTaken(0s));
}

TEST(Exploration, NobodyWaitsForAUnitOfWorkAfterTheLast)
{
    Exploration exploration([] {});
    exploration.SetServed(false);
    EXPECT_FALSE(exploration.WaitUntilTaken(24h));
}

TEST_F(ExplorerTest, NobodyWaitsForAGatewayThatHasEnded)
{
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(1s);
    tool->Manager->Shutdown();
    EXPECT_FALSE(explorer.WaitUntilTaken(24h));
}

TEST(Exploration, AReportIsRequestedAgainAndAgainUntilItHasCome)
{
    using Report = FleetExplorer::Report;
    Exploration exploration([] {});
    exploration.AskForReport("uav1", Report::Echo, 1);
    exploration.AskForReport("uav1", Report::Echo, 2);
    for (int turn = 0; turn < 3; ++turn)
    {
        const auto lacking = exploration.TakeRequests().Lacking;
        ASSERT_THAT(lacking, SizeIs(1));
        EXPECT_EQ(lacking[0].Definition, NodeReports::NameOf(NodeReports::Kind::Echo, 2));
    }
    exploration.AddReport("uav1", {NodeReports::Kind::Echo, 1}, {});
    EXPECT_THAT(exploration.TakeRequests().Lacking, SizeIs(1));
    exploration.AddReport("uav1", {NodeReports::Kind::Echo, 2}, {});
    EXPECT_THAT(exploration.TakeRequests().Lacking, SizeIs(0));
}

TEST_F(ExplorerTest, TellsWhichNodesReadAMessage)
{
    fleet.Add(GroundConfig());
    FleetExplorer &explorer = AddTool(
        [](GatewayConfig &config) { config.Subscribe.push_back({.Message = "Pose", .Type = "Uav::Pose"}); });
    fleet.RunFor(3s);
    EXPECT_FALSE(explorer.FoundSubscribers().has_value());
    explorer.LookForSubscribers({"Pose", "Nothing"});
    ASSERT_TRUE(fleet.RunUntil([&] { return explorer.FoundSubscribers().has_value(); }, 1s));
    const auto found = *explorer.FoundSubscribers();
    EXPECT_THAT(found.at("Pose").Nodes, ::testing::ElementsAre("ground"));
    EXPECT_EQ(found.at("Pose").Others, 0u);
    EXPECT_THAT(found.at("Nothing").Nodes, ::testing::IsEmpty());
}

TEST_F(ExplorerTest, CountsReadersThatAreNoNodesAndNoToolsAmongThem)
{
    Foreign::Network network;
    RemoteEndpoint reader;
    reader.Topic = "Pose";
    reader.Type = "Uav::Pose";
    network.Endpoints = {reader, reader};  // of no node
    network.Endpoints.back().Id = {1};
    reader.Node = "rabit.host.7";  // nobody knows that node
    network.Endpoints.push_back(reader);
    reader.IsWriter = true;
    reader.Node.clear();
    network.Endpoints.push_back(reader);
    Exploration exploration([] {});
    const Foreign::Session session(network);
    exploration.FindSubscribers({"Pose"}, {&session});
    const auto found = exploration.FoundSubscribers();
    EXPECT_EQ(found->at("Pose").Others, 2u);
    EXPECT_THAT(found->at("Pose").Nodes, ::testing::IsEmpty());
    EXPECT_THAT(found->at("Pose").Types, ::testing::ElementsAre("Uav::Pose"));
}

TEST_F(ExplorerTest, FindsReadersOnEachPathAndCountsAProgramOnTwoPathsOnce)
{
    Foreign::Network mesh;
    Foreign::Network modem;
    mesh.Endpoints = {{.Id = {1}, .Topic = "Pose", .Type = "Uav::Pose"}};
    modem.Endpoints = {{.Id = {1}, .Topic = "Pose", .Type = "Uav::Pose"},
                       {.Id = {2}, .Topic = "Pose", .Type = "Uav::Pose"}};
    const Foreign::Session overMesh(mesh);
    const Foreign::Session overModem(modem);
    Exploration exploration([] {});
    exploration.FindSubscribers({"Pose"}, {&overMesh, &overModem});
    EXPECT_EQ(exploration.FoundSubscribers()->at("Pose").Others, 2u);
}

TEST_F(ExplorerTest, TellsHowFarTheWallClocksOfOthersAreAhead)
{
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(2s);
    ASSERT_THAT(explorer.Nodes(), SizeIs(1));
    const double ahead = uav.Clock->GpsTimeSeconds() - tool->Clock->GpsTimeSeconds();
    ASSERT_GT(std::abs(ahead), 1.0) << "no two clocks agree";
    EXPECT_NEAR(explorer.Nodes().front().ClockAhead, ahead, 0.1);
}

TEST_F(ExplorerTest, CountsBeatsThatWereLost)
{
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(20s);
    const FleetExplorer::Node good = explorer.Nodes().front();
    EXPECT_GE(good.BeatsHeard, 30u);
    EXPECT_EQ(good.BeatsMissed, 0u);
    SimulatedFaults faults;
    faults.Loss = 0.5;
    fleet.Network.SetFaults("*", "*", faults);
    fleet.RunFor(20s);
    const FleetExplorer::Node bad = explorer.Nodes().front();
    const double lost = static_cast<double>(bad.BeatsMissed);
    const double heard = static_cast<double>(bad.BeatsHeard - good.BeatsHeard);
    EXPECT_NEAR(lost / (lost + heard), 0.5, 0.3);
}

TEST_F(ExplorerTest, TellsOfLinksThatDoNotGetOnFromBothEnds)
{
    using Kind = FleetExplorer::Strain::Kind;
    using ::testing::ElementsAre;
    using ::testing::Field;
    using Strain = FleetExplorer::Strain;
    const auto queue =
        std::make_shared<RabitMessageQueue<std::shared_ptr<RabitMessage>>>(4, "MissionControl");
    uav.Workspace.AddManagerMessageQueue("MissionControl", queue);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(3s);
    ASSERT_THAT(explorer.Nodes(), SizeIs(2));
    EXPECT_THAT(explorer.Nodes()[0].Strains, ::testing::IsEmpty());
    while (ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()))
    {
    }
    fleet.RunFor(5s);
    EXPECT_THAT(
        explorer.Nodes()[0].Strains,
        ElementsAre(AllOf(Field(&Strain::What, Kind::Filling), Field(&Strain::Other, "uav1"),
                          Field(&Strain::Percent, ::testing::Ge(99u)), Field(&Strain::Messages, 1u))));
    EXPECT_THAT(explorer.Nodes()[1].Strains,
                ElementsAre(AllOf(Field(&Strain::What, Kind::HeldBack), Field(&Strain::Other, "ground"))));
    // The manager takes the waiting messages, so its queue has room again. The refused ones are reported
    // for a while.
    std::shared_ptr<RabitMessage> message;
    fleet.RunUntil(
        [&]
        {
            while (queue->GetMessage(message))
            {
            }
            return ground.LinkTo("uav1", "MissionControl").outbox == 0;
        },
        60s);
    fleet.RunFor(40s);
    EXPECT_THAT(explorer.Nodes()[0].Strains, ::testing::IsEmpty());
    EXPECT_THAT(explorer.Nodes()[1].Strains, ::testing::IsEmpty());
}

TEST_F(ExplorerTest, GetsTheTextOfATypeThatANodePublishesAcceptsOrKnows)
{
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(1s);
    for (const char *type : {"Uav::Pose", "Uav::Goto", "Uav::CommandAck"})
    {
        ASSERT_TRUE(Get(explorer, type)) << type;
        EXPECT_EQ(explorer.TypeText(HashOf(type)), MessageTypeRegistry::Find(type)->IdlText());
    }
}

TEST_F(ExplorerTest, ATextComesWithinASecond)
{
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(2s);
    EXPECT_TRUE(Get(explorer, "Uav::MissionState", 1s));
}

TEST_F(ExplorerTest, ATextComesOverALinkThatLosesHalf)
{
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(2s);
    SimulatedFaults half;
    half.Loss = 0.5;
    fleet.Network.SetFaults("uav1", "tool", half);
    fleet.Network.SetFaults("tool", "uav1", half);
    EXPECT_TRUE(Get(explorer, "Uav::MissionState", 60s));
}

TEST_F(ExplorerTest, OfAHashThatNobodyHasNothingComesAndNothingElseSuffers)
{
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(1s);
    explorer.AskForType("uav1", "Uav::Pose", 12345);
    fleet.RunFor(30s);
    EXPECT_FALSE(explorer.TypeText(12345).has_value());
    EXPECT_TRUE(Get(explorer, "Uav::Pose"));
}

TEST_F(ExplorerTest, AnAnswerGoesToWhoAskedAlone)
{
    int frames = 0;
    HandNode other(fleet.Network, "other", 1);
    const auto reader = other.Session().CreateReader(
        DescribeLinkTopic(), LinkTopicQos(), {}, [&frames](SampleBytes, const SampleInfo &) { ++frames; });
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(2s);
    ASSERT_TRUE(Get(explorer, "Uav::Pose"));
    EXPECT_EQ(frames, 0);
}

TEST_F(ExplorerTest, AnAnswerKeepsToTheBudgetOfTheRadio)
{
    GatewayConfig config = AircraftConfig("uav2");
    config.Radio.Budget = 1000;
    fleet.Add(config);
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(20s);
    std::vector<std::uint64_t> wanted;
    for (const std::string &type : MessageTypeRegistry::Names())
    {
        if (type.rfind("Uav::", 0) == 0)
        {
            wanted.push_back(HashOf(type));
            explorer.AskForType("uav2", type, wanted.back());
        }
    }
    ASSERT_GT(wanted.size(), 5u);
    const auto sent = [this] { return fleet.Network.Sent("uav2").Bytes; };
    for (int second = 0; second < 10; ++second)
    {
        const std::uint64_t before = sent();
        fleet.RunFor(1s);
        EXPECT_LE(sent() - before, 1000u) << second;
    }
    EXPECT_TRUE(fleet.RunUntil(
        [&]
        {
            return std::all_of(wanted.begin(), wanted.end(),
                               [&](std::uint64_t definition)
                               { return explorer.TypeText(definition).has_value(); });
        },
        120s));
}

// A node that answers requests, and sends answers without a request, with any contents.
TEST_F(ExplorerTest, WhatStrangersAnswerIsCheckedAndBounded)
{
    FleetExplorer &explorer = AddTool();
    HandNode liar(fleet.Network, "liar", 1);
    const auto writer = liar.Session().CreateWriter(DescribeLinkTopic(), LinkTopicQos(), {});
    fleet.RunFor(2s);
    Gateway::Beat beat = liar.Beat();
    beat.next_ms = 20000;
    liar.Write(beat);
    explorer.AskForType("liar", "Uav::Pose", HashOf("Uav::Pose"));
    fleet.RunFor(1s);
    const auto answer = [&](std::uint64_t definition, const std::string &text, std::uint32_t of)
    {
        const auto *bytes = reinterpret_cast<const std::uint8_t *>(text.data());
        const auto frame = TypeFrames::Encode(
            {.Definition = definition, .First = 0, .Of = of, .Bytes = std::span(bytes, text.size())});
        EXPECT_EQ(writer->WriteTo("tool", FrameBytesEncoder(frame), 1), WriteResult::Ok);
    };
    const std::uint64_t before = tool->Fleet().malformed;
    answer(HashOf("Uav::Pose"), "module Uav { struct Pose { long lie; }; };", 42);
    answer(HashOf("Uav::Goto"), "unasked", 7);
    answer(HashOf("Uav::Pose"), "too large", 1u << 30);
    fleet.RunFor(3s);
    EXPECT_FALSE(explorer.TypeText(HashOf("Uav::Pose")).has_value());
    EXPECT_FALSE(explorer.TypeText(HashOf("Uav::Goto")).has_value());
    EXPECT_EQ(tool->Fleet().malformed, before + 3);
    const std::string text = MessageTypeRegistry::Find("Uav::Pose")->IdlText();
    answer(HashOf("Uav::Pose"), text, static_cast<std::uint32_t>(text.size()));
    fleet.RunFor(1s);
    EXPECT_EQ(explorer.TypeText(HashOf("Uav::Pose")), text);
}

TEST_F(ExplorerTest, SubscribesWhileItRunsAndHasTheLastStateAtOnce)
{
    const auto state = uav.Register<Uav::MissionState>("MissionState");
    state->PostMessage();
    FleetExplorer &explorer = AddTool();
    fleet.RunFor(5s);
    explorer.Subscribe({.Message = "MissionState", .Type = "Uav::MissionState"});
    const auto received = tool->Register<Uav::MissionState>("uav1/MissionState");
    EXPECT_TRUE(fleet.RunUntil([&] { return received->FetchMessage(); }, 1s));
    state->PostMessage();
    EXPECT_TRUE(fleet.RunUntil([&] { return received->FetchMessage(); }, 1s));
}

TEST_F(ExplorerTest, AnEarlierSubscriptionGoesOnWhenOneIsAdded)
{
    const auto state = uav.Register<Uav::MissionState>("MissionState");
    const auto pose = uav.Register<Uav::Pose>("Pose");
    state->PostMessage();
    FleetExplorer &explorer =
        AddTool([](GatewayConfig &config)
                { config.Subscribe.push_back({.Message = "MissionState", .Type = "Uav::MissionState"}); });
    const auto received = tool->Register<Uav::MissionState>("uav1/MissionState");
    const auto receivedPose = tool->Register<Uav::Pose>("uav1/Pose");
    fleet.RunFor(5s);
    ASSERT_TRUE(received->FetchMessage());
    explorer.Subscribe({.Message = "Pose", .Type = "Uav::Pose"});
    fleet.RunFor(2s);
    EXPECT_FALSE(received->FetchMessage()) << "posted again";
    pose->PostMessage();
    state->PostMessage();
    fleet.RunFor(2s);
    EXPECT_TRUE(received->FetchMessage());
    EXPECT_TRUE(receivedPose->FetchMessage());
}

TEST_F(ExplorerTest, ASecondSubscriptionOfAMessageAddsItsNodes)
{
    SimulatedNode &other = fleet.Add(AircraftConfig("uav2"));
    const auto first = uav.Register<Uav::MissionState>("MissionState");
    const auto second = other.Register<Uav::MissionState>("MissionState");
    first->PostMessage();
    second->PostMessage();
    FleetExplorer &explorer = AddTool();
    const auto fromFirst = tool->Register<Uav::MissionState>("uav1/MissionState");
    const auto fromSecond = tool->Register<Uav::MissionState>("uav2/MissionState");
    explorer.Subscribe({.Message = "MissionState", .Type = "Uav::MissionState", .From = {"uav1"}});
    fleet.RunFor(5s);
    EXPECT_TRUE(fromFirst->FetchMessage());
    ASSERT_FALSE(fromSecond->WasPosted());
    explorer.Subscribe({.Message = "MissionState", .Type = "Uav::MissionState", .From = {"uav2"}});
    fleet.RunFor(5s);
    EXPECT_TRUE(fromSecond->WasPosted() || fromSecond->FetchMessage());
    first->PostMessage();
    fleet.RunFor(2s);
    EXPECT_TRUE(fromFirst->FetchMessage());
}

TEST_F(ExplorerTest, MessagesExpireAfterTheTimeThatWasSetForTheirQueue)
{
    SimulatedNode &ground = fleet.Add(GroundConfig());
    fleet.RunFor(5s);
    ground.Manager->Explorer().SetExpiry("uav?", "MissionControl", 2s);
    SimulatedFaults nothing;
    nothing.Loss = 1.0;
    fleet.Network.SetFaults("ground", "uav1", nothing);
    const auto receipt = std::make_shared<RabitQueueReceipt>();
    ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>(), receipt);
    fleet.RunFor(1s);
    EXPECT_EQ(receipt->Outcome(), QueueOutcome::Pending);
    EXPECT_TRUE(fleet.RunUntil([&] { return receipt->Outcome() != QueueOutcome::Pending; }, 30s));
}

TEST_F(ExplorerTest, AnExpiryOutOfRangeIsAMistakeOfTheCaller)
{
    FleetExplorer &explorer = AddTool();
    EXPECT_THROW(explorer.SetExpiry("uav?", "MissionControl", -1ms), std::invalid_argument);
    EXPECT_THROW(explorer.SetExpiry("uav?", "MissionControl", 24h * 366), std::invalid_argument);
}

TEST_F(ExplorerTest, ASubscriptionToATypeThatIsNotThereIsAMistakeOfTheCaller)
{
    FleetExplorer &explorer = AddTool();
    EXPECT_THROW(explorer.Subscribe({.Message = "Pose", .Type = "Uav::Poze"}), std::invalid_argument);
}

TEST_F(ExplorerTest, SaysWhenSomethingIsNew)
{
    FleetExplorer &explorer = AddTool();
    int changes = 0;
    explorer.SetOnChange([&changes] { ++changes; });
    fleet.RunFor(2s);
    EXPECT_GT(changes, 0);
    const int before = changes;
    ASSERT_TRUE(Get(explorer, "Uav::Pose"));
    EXPECT_GT(changes, before);
}

TEST_F(ExplorerTest, TellsThatANodeHearsTheNodesThatTheToolHears)
{
    fleet.Add(AircraftConfig("uav2"));
    fleet.RunFor(3s);
    const FleetExplorer &explorer = AddTool();
    const auto doAll = [&explorer]
    {
        const auto nodes = explorer.Nodes();
        return nodes.size() == 2 && nodes[0].HearsTheSame && nodes[1].HearsTheSame;
    };
    EXPECT_TRUE(fleet.RunUntil(doAll, 1s));
}

TEST_F(ExplorerTest, NodesTellAgainOfWhomTheyHearWhenANodeComesOrGoesWhileAToolIsThere)
{
    fleet.Add(AircraftConfig("uav2"));
    const FleetExplorer &explorer = AddTool();
    fleet.RunFor(10s);
    const auto doAllHear = [&explorer](std::size_t live)
    {
        const auto nodes = explorer.Nodes();
        const auto isLive = [](const FleetExplorer::Node &node)
        { return node.State != Gateway::NodeState::LOST; };
        return std::count_if(nodes.begin(), nodes.end(), isLive) == static_cast<std::ptrdiff_t>(live) &&
               std::all_of(nodes.begin(), nodes.end(),
                           [&](const FleetExplorer::Node &node)
                           { return !isLive(node) || node.HearsTheSame; });
    };
    ASSERT_TRUE(doAllHear(2));
    fleet.Add(AircraftConfig("uav3"));
    EXPECT_TRUE(fleet.RunUntil([&] { return doAllHear(3); }, 2s));
    fleet.Kill("uav3");
    EXPECT_TRUE(fleet.RunUntil([&] { return doAllHear(2); }, 10s));
}

TEST_F(ExplorerTest, ANodeThatTheToolHearsLateIsLackingUntilThen)
{
    fleet.Add(AircraftConfig("uav2"));
    fleet.RunFor(3s);
    SimulatedFaults nothing;
    nothing.Loss = 1.0;
    fleet.Network.SetFaults("uav2", "tool", nothing);
    const FleetExplorer &explorer = AddTool();
    fleet.RunFor(5s);
    ASSERT_THAT(explorer.Nodes(), SizeIs(1));
    EXPECT_TRUE(explorer.Nodes()[0].Offers.has_value());
    EXPECT_FALSE(explorer.Nodes()[0].HearsTheSame);
    fleet.Network.SetFaults("uav2", "tool", {});
    const auto isKnown = [&explorer]
    {
        const auto nodes = explorer.Nodes();
        return nodes.size() == 2 && nodes[0].HearsTheSame;
    };
    EXPECT_TRUE(fleet.RunUntil(isKnown, 5s));
}

}  // namespace
}  // namespace Rabit
