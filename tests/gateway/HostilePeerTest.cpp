// The cost to its peers of a node that lies, that requests without end, or of many nodes: whole nodes on
// the simulated network.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "HandNode.h"
#include "SimulatedFleet.h"
#include "presence/MissingOffers.h"
#include "wire/BeatExtensions.h"
#include "wire/BeatFormat.h"
#include "wire/BeatNews.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::IsEmpty;

GatewayConfig Node(const std::string &name)
{
    GatewayConfig config;
    config.Node = name;
    return config;
}

// Returns a configuration whose announcement has the largest size allowed.
GatewayConfig LongConfig(const std::string &name)
{
    GatewayConfig config = Node(name);
    for (int i = 0; i < 180; ++i)
    {
        AcceptRule rule;
        rule.Queue = std::string(110, 'q').append(std::to_string(i));
        rule.Types = {"Uav::Goto"};
        config.Accept.push_back(rule);
    }
    return config;
}

// The requests in a beat, without its extensions.
std::size_t QuestionsIn(const Gateway::Beat &beat)
{
    const auto &wants = NewsOf(beat).wants;
    return static_cast<std::size_t>(std::count_if(wants.begin(), wants.end(),
                                                  [](const Gateway::Wanted &wanted)
                                                  { return wanted.node != BeatExtensions::Nobody; }));
}

class HostilePeerTest : public ::testing::Test
{
protected:
    HostilePeerTest()
        : uav(fleet.Add(AircraftConfig("uav1"))),
          listener(fleet.Network, "listener", 1,
                   [this](SampleBytes bytes, const SampleInfo &info) { Hear(bytes, info); })
    {
        fleet.RunFor(20s);
        heard.clear();
        bytesHeard = 0;
    }

    // Handles the beats of uav1.
    void Hear(SampleBytes bytes, const SampleInfo &info)
    {
        if (info.Node == "uav1")
        {
            Gateway::Beat beat;
            ASSERT_TRUE(MessageTypeRegistry::Of(beat)->Deserialize(bytes, beat));
            heard.push_back(beat);
            bytesHeard += bytes.size();
        }
    }

    HandNode &AddPeer(const std::string &name)
    {
        peers.push_back(std::make_unique<HandNode>(fleet.Network, name, 5));
        return *peers.back();
    }

    SimulatedFleet fleet;
    SimulatedNode &uav;
    std::vector<Gateway::Beat> heard;
    std::size_t bytesHeard = 0;
    HandNode listener;
    std::vector<std::unique_ptr<HandNode>> peers;
};

TEST_F(HostilePeerTest, WhoMeansAnotherAnnouncementWithEachBeatAndSendsNoneIsAskedSeldom)
{
    HandNode &liar = AddPeer("liar");
    fleet.RunFor(1s);
    heard.clear();
    for (std::uint32_t i = 0; i < 6000; ++i)
    {
        Gateway::Beat beat = liar.Beat();
        beat.offers = i;
        liar.Write(beat);
        fleet.RunFor(10ms);
    }
    const auto asked = std::count_if(heard.begin(), heard.end(),
                                     [](const Gateway::Beat &beat) { return QuestionsIn(beat) > 0; });
    EXPECT_GE(asked, 30);
    EXPECT_LE(asked, 40 + MissingOffers::QuickQuestions);
    EXPECT_LE(heard.size(), 120u + 40u + 5u + static_cast<unsigned>(MissingOffers::QuickQuestions));
}

TEST_F(HostilePeerTest, WhoSendsAPieceOfAnotherAnnouncementWithEachBeatKeepsNobodyFromBeingKnown)
{
    HandNode &liar = AddPeer("liar");
    fleet.RunFor(1s);
    SimulatedNode &ground = fleet.Add(LongConfig("ground"));
    for (std::uint32_t i = 0; i < 3000; ++i)
    {
        Gateway::Beat beat = liar.Beat();
        beat.offers = i;
        Gateway::AnnouncementPart &part = NewsOf(beat).parts.emplace_back();
        part.first = static_cast<std::uint16_t>(i % 30000);
        part.of = 32768;
        part.bytes.assign(800, 1);
        liar.Write(beat);
        fleet.RunFor(10ms);
    }
    EXPECT_TRUE(uav.Workspace.AddMessageToQueue("ground/" + std::string(110, 'q') + "179",
                                                std::make_shared<Uav::Goto>()));
    EXPECT_EQ(uav.StateOf("ground"), "UP");
    EXPECT_EQ(ground.StateOf("uav1"), "UP");
}

TEST_F(HostilePeerTest, WhoSendsAnnouncementsThatAreNotWhatTheirDigestSaysIsCounted)
{
    HandNode &liar = AddPeer("liar");
    fleet.RunFor(1s);
    Gateway::Beat beat = liar.Beat();
    Announce(beat, {});
    beat.offers ^= 1;
    liar.Write(beat);
    fleet.RunFor(2s);
    EXPECT_EQ(uav.Fleet().malformed, 1u);
}

TEST_F(HostilePeerTest, WhoAsksForEverythingWithoutEndGetsTwiceAsManyBeatsAtMost)
{
    HandNode &asker = AddPeer("asker");
    fleet.RunFor(1s);
    heard.clear();
    bytesHeard = 0;
    for (int i = 0; i < 6000; ++i)
    {
        Gateway::Beat beat = asker.Beat();
        for (std::uint32_t other = 0; other < 200; ++other)
        {
            NewsOf(beat).wants.emplace_back().node = other;
        }
        Gateway::Wanted &wanted = NewsOf(beat).wants.emplace_back();
        wanted.node = NodeTagOf("uav1", uav.Fleet().incarnation);
        wanted.offers = static_cast<std::uint16_t>(i % 300);
        wanted.states.assign(64, 0xff);
        asker.Write(beat);
        fleet.RunFor(10ms);
    }
    EXPECT_LE(heard.size(), 120u + 40u);
    EXPECT_LE(bytesHeard, 160u * 250u);
}

TEST_F(HostilePeerTest, ManyThatMeanWhatTheyDoNotSendDoNotMakeANodeShout)
{
    for (int i = 0; i < 100; ++i)
    {
        AddPeer(std::string("liar").append(std::to_string(i)));
    }
    fleet.RunFor(10s);
    heard.clear();
    for (std::uint32_t second = 0; second < 30; ++second)
    {
        for (auto &peer : peers)
        {
            Gateway::Beat beat = peer->Beat();
            beat.offers = second;
            peer->Write(beat);
        }
        fleet.RunFor(1s);
    }
    EXPECT_LE(heard.size(), 60u + 30u);
    for (const Gateway::Beat &beat : heard)
    {
        EXPECT_LE(QuestionsIn(beat), BeatFormat::MostWants);
    }
}

TEST_F(HostilePeerTest, WhatEchoesAndDelaysSayOfOthersMeansNothing)
{
    HandNode &liar = AddPeer("liar");
    fleet.RunFor(1s);
    for (int i = 0; i < 10; ++i)
    {
        Gateway::Beat beat = liar.Beat();
        Announce(beat, {});
        for (std::uint32_t other = 0; other < 100; ++other)
        {
            Gateway::BeatEcho &echo = NewsOf(beat).echoes.emplace_back();
            echo.node = NodeTagOf("uav1", uav.Fleet().incarnation);
            echo.beat = other;
            NewsOf(beat).delays.emplace_back().node = other;
        }
        liar.Write(beat);
        fleet.RunFor(500ms);
    }
    ASSERT_EQ(uav.StateOf("liar"), "UP");
    for (const Gateway::NodeStatus &status : uav.Fleet().nodes)
    {
        EXPECT_TRUE(status.node != "liar" || std::isnan(status.round_trip_s));
    }
}

TEST(ThinPresence, TheLargestAnnouncementGetsThroughWhereAThirdIsLost)
{
    SimulatedFleet fleet;
    SimulatedFaults faults;
    faults.Loss = 0.3;
    fleet.Network.SetFaults("*", "*", faults);
    SimulatedNode &uav = fleet.Add(Node("uav1"));
    fleet.Add(LongConfig("ground"));
    const std::string queue = "ground/" + std::string(110, 'q') + "179";
    EXPECT_TRUE(fleet.RunUntil(
        [&] { return uav.Workspace.AddMessageToQueue(queue, std::make_shared<Uav::Goto>()); }, 60s));
}

TEST(ThinPresence, AGoodbyeIsHeardWhereAThirdIsLost)
{
    int heard = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
    {
        SimulatedFleet fleet(seed);
        SimulatedNode &uav = fleet.Add(Node("uav1"));
        fleet.Add(Node("ground"));
        fleet.RunFor(3s);
        SimulatedFaults faults;
        faults.Loss = 0.33;
        fleet.Network.SetFaults("*", "*", faults);
        fleet.Stop("ground");
        heard += fleet.RunUntil([&] { return uav.StateOf("ground") == "LOST"; }, 100ms) ? 1 : 0;
    }
    EXPECT_GE(heard, 18);
}

TEST(ThinPresence, ANodeThatRestartsUnchangedIsNotAskedForItsAnnouncement)
{
    SimulatedFleet fleet;
    SimulatedNode &uav = fleet.Add(Node("uav1"));
    fleet.Add(AircraftConfig("uav2"), 1.4e9);
    fleet.RunFor(3s);
    fleet.Kill("uav2");
    fleet.RunFor(3s);
    std::size_t wants = 0;
    HandNode listener(fleet.Network, "listener", 1,
                      [&](SampleBytes bytes, const SampleInfo &info)
                      {
                          Gateway::Beat beat;
                          ASSERT_TRUE(MessageTypeRegistry::Of(beat)->Deserialize(bytes, beat));
                          wants += info.Node == "uav1" ? NewsOf(beat).wants.size() : 0;
                      });
    fleet.Add(AircraftConfig("uav2"), 1.4e9 + 100);
    fleet.RunFor(5s);
    EXPECT_EQ(uav.StateOf("uav2"), "UP");
    EXPECT_EQ(wants, 0u);
}

// The limit of an idle fleet of N nodes: 300 N + 20 N (N - 1) bytes a second, DDS's own included.
TEST(ThinPresence, AnIdleFleetOfTenSaysLittle)
{
    SimulatedFleet fleet;
    std::vector<SimulatedNode *> nodes;
    for (int i = 0; i < 10; ++i)
    {
        GatewayConfig config = Node(std::string("n").append(std::to_string(i)));
        config.Accept.push_back({.Queue = "Q", .Types = {"Uav::Goto"}});
        nodes.push_back(&fleet.Add(config));
    }
    fleet.RunFor(60s);
    double presence = 0.0;
    double used = 0.0;
    for (int second = 0; second < 20; ++second)
    {
        fleet.RunFor(1s);
        for (SimulatedNode *node : nodes)
        {
            presence += node->Fleet().air.presence / 20;
            used += node->Fleet().air.used / 20;
        }
    }
    EXPECT_LE(presence, 10 * 264 + 10 * 9 * 20);
    EXPECT_LE(used, 10 * 300 + 10 * 9 * 20);
}

}  // namespace
}  // namespace Rabit
