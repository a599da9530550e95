#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include "mavlink/MavlinkFrame.h"
#include "mavlink/MavlinkMessages.h"

namespace Swarm
{
namespace
{

using Bytes = std::vector<std::uint8_t>;

Bytes Concatenate(std::initializer_list<Bytes> parts)
{
    Bytes all;
    for (const Bytes &part : parts)
    {
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

MavlinkFrame HeartbeatFrame(MavlinkFrame::Version version = MavlinkFrame::Version::Two)
{
    MavlinkFrame frame = MavlinkHeartbeat{.CustomMode = 0x01020304, .Type = 2, .Autopilot = 3}.Encode();
    frame.Protocol = version;
    frame.Sequence = 77;
    frame.System = 5;
    frame.Component = 6;
    return frame;
}

void ExpectSame(const MavlinkFrame &a, const MavlinkFrame &b)
{
    EXPECT_EQ(a.Protocol, b.Protocol);
    EXPECT_EQ(a.Sequence, b.Sequence);
    EXPECT_EQ(a.System, b.System);
    EXPECT_EQ(a.Component, b.Component);
    EXPECT_EQ(a.Message, b.Message);
    EXPECT_EQ(a.Payload, b.Payload);
}

TEST(MavlinkFrame, ItsChecksumHasTheCheckValueOfCrc16Mcrf4xx)
{
    constexpr std::string_view digits = "123456789";
    EXPECT_EQ(MavlinkChecksum(Bytes(digits.begin(), digits.end())), 0x6F91);
}

TEST(MavlinkFrame, VersionOneIsLaidOutAsTheProtocolSays)
{
    const Bytes bytes = EncodeMavlink(HeartbeatFrame(MavlinkFrame::Version::One));
    ASSERT_EQ(bytes.size(), 17u);
    EXPECT_EQ(Bytes(bytes.begin(), bytes.end() - 2),
              (Bytes{0xFE, 9, 77, 5, 6, 0, 4, 3, 2, 1, 2, 3, 0, 0, 3}));
}

TEST(MavlinkFrame, VersionTwoIsLaidOutAsTheProtocolSays)
{
    const Bytes bytes = EncodeMavlink(HeartbeatFrame());
    ASSERT_EQ(bytes.size(), 21u);
    EXPECT_EQ(Bytes(bytes.begin(), bytes.end() - 2),
              (Bytes{0xFD, 9, 0, 0, 77, 5, 6, 0, 0, 0, 4, 3, 2, 1, 2, 3, 0, 0, 3}));
}

TEST(MavlinkFrame, VersionTwoDoesNotSendZerosAtTheEndButAlwaysOneByte)
{
    MavlinkFrame frame = HeartbeatFrame();
    frame.Payload = Bytes(9, 0);
    const Bytes bytes = EncodeMavlink(frame);
    EXPECT_EQ(bytes.size(), 10u + 1u + 2u);
}

TEST(MavlinkFrame, WhatCannotBeSentIsRefused)
{
    MavlinkFrame unknown = HeartbeatFrame();
    unknown.Message = 1;
    EXPECT_THROW(EncodeMavlink(unknown), std::invalid_argument);
    MavlinkFrame empty = HeartbeatFrame();
    empty.Payload.clear();
    EXPECT_THROW(EncodeMavlink(empty), std::invalid_argument);
}

class MavlinkParserTest : public ::testing::TestWithParam<MavlinkFrame::Version>
{
};

TEST_P(MavlinkParserTest, FindsFramesWhereverTheStreamIsCut)
{
    const MavlinkFrame sent = HeartbeatFrame(GetParam());
    const Bytes one = EncodeMavlink(sent);
    const Bytes stream = Concatenate({one, one, one});
    for (std::size_t size = 1; size <= stream.size(); ++size)
    {
        MavlinkParser parser;
        std::size_t found = 0;
        for (std::size_t at = 0; at < stream.size(); at += size)
        {
            parser.Add(std::span(stream).subspan(at, std::min(size, stream.size() - at)));
            while (const auto frame = parser.Next())
            {
                ExpectSame(*frame, sent);
                ++found;
            }
        }
        EXPECT_EQ(found, 3u) << "in pieces of " << size;
        EXPECT_EQ(parser.Count().Skipped, 0u);
    }
}

TEST_P(MavlinkParserTest, AFrameInsideNoiseIsFound)
{
    const Bytes frame = EncodeMavlink(HeartbeatFrame(GetParam()));
    MavlinkParser parser;
    parser.Add(Concatenate({{1, 2, 3}, frame, {4, 5}}));
    EXPECT_TRUE(parser.Next());
    EXPECT_FALSE(parser.Next());
    EXPECT_EQ(parser.Count().Skipped, 5u);
}

TEST_P(MavlinkParserTest, EveryChangedByteIsNoticed)
{
    const Bytes good = EncodeMavlink(HeartbeatFrame(GetParam()));
    for (std::size_t at = 1; at < good.size(); ++at)
    {
        Bytes bad = good;
        bad[at] = static_cast<std::uint8_t>(bad[at] ^ 0x10);
        MavlinkParser parser;
        parser.Add(Concatenate({bad, Bytes(300, 0)}));
        EXPECT_FALSE(parser.Next()) << "byte " << at;
    }
}

INSTANTIATE_TEST_SUITE_P(BothVersions, MavlinkParserTest,
                         ::testing::Values(MavlinkFrame::Version::One, MavlinkFrame::Version::Two));

TEST(MavlinkParser, AFrameOfAnUnknownTypeIsPassedOverAsAWhole)
{
    // Message 24, with a start byte in its payload.
    const Bytes unknown = {0xFD, 3, 0, 0, 1, 1, 1, 24, 0, 0, 0xFD, 0xFE, 9, 0x12, 0x34};
    MavlinkParser parser;
    parser.Add(Concatenate({unknown, EncodeMavlink(HeartbeatFrame())}));
    EXPECT_TRUE(parser.Next());
    EXPECT_EQ(parser.Count().Unknown, 1u);
    EXPECT_EQ(parser.Count().Skipped, 0u);
}

TEST(MavlinkParser, ASignedFrameIsTakenWithoutItsSignature)
{
    Bytes bytes = EncodeMavlink(HeartbeatFrame());
    bytes[2] = 1;  // the flag is part of what is checked
    const std::uint8_t extra = MavlinkHeartbeat::Extra;
    const std::uint16_t sum =
        MavlinkChecksum({&extra, 1}, MavlinkChecksum(std::span(bytes).subspan(1, bytes.size() - 3)));
    bytes[bytes.size() - 2] = static_cast<std::uint8_t>(sum & 0xFF);
    bytes[bytes.size() - 1] = static_cast<std::uint8_t>(sum >> 8);
    MavlinkParser parser;
    parser.Add(Concatenate({bytes, Bytes(13, 0xAA), EncodeMavlink(HeartbeatFrame())}));
    EXPECT_TRUE(parser.Next());
    EXPECT_TRUE(parser.Next());
    EXPECT_EQ(parser.Count().Skipped, 0u);
}

TEST(MavlinkParser, AnyBytesAreSafeToParse)
{
    std::mt19937 random(4711);
    MavlinkParser parser;
    for (int round = 0; round < 2000; ++round)
    {
        Bytes bytes(random() % 400);
        for (std::uint8_t &byte : bytes)
        {
            byte = random() % 8 == 0 ? std::uint8_t{0xFD} : static_cast<std::uint8_t>(random());
        }
        parser.Add(bytes);
        while (parser.Next())
        {
        }
    }
    EXPECT_GT(parser.Count().Skipped, 0u);
}

}  // namespace
}  // namespace Swarm
