// Beats and announcements.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "Hex.h"
#include "gateway.idl.h"
#include "names/NodeTag.h"
#include "names/TypeDefinition.h"
#include "presence/PresenceInbox.h"
#include "wire/Announcements.h"
#include "wire/BeatExtensions.h"
#include "wire/BeatFormat.h"
#include "wire/BeatNews.h"
#include "wire/GatewayTopics.h"

namespace Rabit::Test
{
namespace
{

constexpr const char *FullBeatBytes =
    "0001000103bef40104030201efcdab8967452301000102000200000001000000\n"
    "feffffff05000000ddccbbaa2c01000002000000058000000000000001000000\n"
    "0000000000000000030000000000000000000000020000001000000098badcfe\n"
    "887766554433221170110100000000000400000008000000070000000157ffff\n"
    "01000000ddccbbaaefcdab89dc0500000100000044332211fa00140001000000\n"
    "1000140003000000deadbe00";
constexpr const char *ProblemBeatBytes =
    "0001000003bef401040302010100000000000000000100000000000001000000\n"
    "000000000500000006000000030098badcfe0000000000000000000000000000";
constexpr const char *FleetBeatBytes =
    "0001000003bef401040302010100000000000000000100000000000001000000\n"
    "00000000070000000400000098badcfe000000000000000000000000";
constexpr const char *LastBeatBytes = "0001000103be60eaffffffff010000000000000001000000";
constexpr const char *AnnouncementBytes =
    "000100030200000005000000506f7365000000000a0000005561763a3a506f73\n"
    "650000000a00000074656c656d65747279000000efcdab89674523010b000000\n"
    "536561726368417265610000100000005561763a3a5365617263684172656100\n"
    "0600000073746174650000000000000000000000010000000f0000004d697373\n"
    "696f6e436f6e74726f6c0000010000000c0000005561763a3a476f486f6d6500\n"
    "000000001032547698badcfe020000000700000067726f756e64000005000000\n"
    "7561762a00000000";

// A beat without news.
Gateway::Beat BareBeat(std::int64_t sourceNs)
{
    Gateway::Beat beat;
    beat.format = BeatFormat::Present;
    beat.next_ms = 500;
    beat.offers = 0x01020304;
    beat.source_ns = sourceNs;
    return beat;
}

// A beat with everything that a beat can have.
Gateway::Beat FullBeat()
{
    Gateway::Beat beat = BareBeat(0x0123456789abcdef);
    Gateway::BeatNews &news = NewsOf(beat);
    news.first_state = 2;
    news.states = {1, 0xfffffffe};
    Gateway::Wanted &wanted = news.wants.emplace_back();
    wanted.node = 0xaabbccdd;
    wanted.offers = 300;
    wanted.states = {5, 0x80};
    BeatExtensions::MarkTool(beat);
    BeatExtensions::MarkReplay(beat);
    BeatExtensions::Ask(beat, {.Node = 0xfedcba98, .Definition = 0x1122334455667788, .From = 70000});
    const LinkStrain strain{.Node = 7, .What = LinkStrain::Kind::Filling, .Percent = 87, .Messages = 65535};
    BeatExtensions::Say(beat, {&strain, 1});
    Gateway::BeatEcho &echo = news.echoes.emplace_back();
    echo.node = 0xaabbccdd;
    echo.beat = 0x89abcdef;
    echo.held_us = 1500;
    Gateway::DelayReport &delay = news.delays.emplace_back();
    delay.node = 0x11223344;
    delay.delay_ms = 250;
    delay.held_ms = 20;
    Gateway::AnnouncementPart &part = news.parts.emplace_back();
    part.first = 16;
    part.of = 20;
    part.bytes = {0xde, 0xad, 0xbe};
    return beat;
}

// A beat of a node with problems.
Gateway::Beat ProblemBeat()
{
    Gateway::Beat beat = BareBeat(1);
    BeatExtensions::Say(beat, ProblemCount{.Count = 3, .Digest = 0xfedcba98});
    return beat;
}

// A beat of a node that has heard a tool.
Gateway::Beat FleetBeat()
{
    Gateway::Beat beat = BareBeat(1);
    BeatExtensions::SayFleetSum(beat, 0xfedcba98);
    return beat;
}

// The goodbye of a node without news.
Gateway::Beat LastBeat()
{
    Gateway::Beat beat;
    beat.format = BeatFormat::Present;
    beat.next_ms = 60000;
    beat.offers = 0xffffffff;
    beat.source_ns = 1;
    beat.leaving = true;
    DropEmptyNews(beat);
    return beat;
}

Gateway::Announcement FullAnnouncement()
{
    Gateway::Announcement announcement;
    Gateway::PublishedMessage &pose = announcement.publishes.emplace_back();
    pose.message = "Pose";
    pose.type = "Uav::Pose";
    pose.qos = "telemetry";
    pose.definition = 0x0123456789abcdef;
    Gateway::PublishedMessage &area = announcement.publishes.emplace_back();
    area.message = "SearchArea";
    area.type = "Uav::SearchArea";
    area.qos = "state";
    Gateway::AcceptedQueue &queue = announcement.accepts.emplace_back();
    queue.queue = "MissionControl";
    Gateway::QueueType &order = queue.types.emplace_back();
    order.type = "Uav::GoHome";
    order.definition = 0xfedcba9876543210;
    queue.from = {"ground", "uav*"};
    return announcement;
}

std::vector<std::uint8_t> Encoded(const Gateway::Beat &beat)
{
    const MessageType &type = GatewayTopics::TypeOf<Gateway::Beat>();
    std::vector<std::uint8_t> bytes(type.SerializedSize(beat));
    EXPECT_EQ(type.Serialize(beat, bytes), bytes.size());
    return bytes;
}

// The beat as a gateway accepts it.
Gateway::Beat Accepted(const std::vector<std::uint8_t> &bytes)
{
    PresenceInbox inbox;
    SampleInfo info;
    info.Node = "uav1";
    info.Incarnation = 1;
    EXPECT_TRUE(inbox.AddBeat(bytes, info, std::chrono::seconds(1)));
    const PresenceInbox::Contents contents = inbox.Take();
    return contents.Beats.empty() ? Gateway::Beat() : contents.Beats.front().Beat;
}

TEST(PresenceBytes, OfAFullBeatAreAccepted)
{
    EXPECT_EQ(Accepted(BytesOf(FullBeatBytes)), FullBeat());
}

TEST(PresenceBytes, OfAFullBeatAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(Encoded(FullBeat())), FullBeatBytes);
}

TEST(PresenceBytes, OfAGoodbyeAreAccepted)
{
    EXPECT_EQ(Accepted(BytesOf(LastBeatBytes)), LastBeat());
}

TEST(PresenceBytes, OfAGoodbyeAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(Encoded(LastBeat())), LastBeatBytes);
}

TEST(PresenceBytes, OfAnAnnouncementAreAccepted)
{
    EXPECT_EQ(Announcements::Decode(BytesOf(AnnouncementBytes)), FullAnnouncement());
}

TEST(PresenceBytes, OfAnAnnouncementAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(Announcements::Encode(FullAnnouncement())), AnnouncementBytes);
}

// Beats and announcements name nodes, announcements and types by hashes, which both sides compute.
TEST(PresenceBytes, HashesAreTheRecordedOnes)
{
    EXPECT_EQ(NodeTagOf("uav1", 0x0123456789abcdef), 1570923401U);
    EXPECT_EQ(Announcements::DigestOf(BytesOf("00010203")), 3700778606U);
    EXPECT_EQ(DefinitionHash("Uav::Pose", "module Uav { struct Pose { double x; }; };"),
              8397531700064043858U);
}

TEST(PresenceBytes, OfABeatWithProblemsAreAccepted)
{
    const ProblemCount expected{.Count = 3, .Digest = 0xfedcba98};
    EXPECT_EQ(BeatExtensions::ProblemsIn(Accepted(BytesOf(ProblemBeatBytes))), expected);
}

TEST(PresenceBytes, OfABeatWithProblemsAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(Encoded(ProblemBeat())), ProblemBeatBytes);
}

TEST(PresenceBytes, OfABeatToAToolAreAccepted)
{
    EXPECT_EQ(BeatExtensions::FleetSumIn(Accepted(BytesOf(FleetBeatBytes))), 0xfedcba98);
}

TEST(PresenceBytes, OfABeatToAToolAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(Encoded(FleetBeat())), FleetBeatBytes);
}

}  // namespace
}  // namespace Rabit::Test
