// Frames as bytes: equal after encoding and decoding, and safe with any bytes.
#include <gtest/gtest.h>
#include <rabit/gateway/links/LinkFrameCodec.h>
#include <rabit/gateway/links/LinkTime.h>

#include <chrono>
#include <random>
#include <string>
#include <vector>

#include "OutcomeHistory.h"
#include "StoredMessages.h"

namespace Rabit::Test
{
namespace
{

using namespace std::chrono_literals;

std::vector<std::uint8_t> Encoded(const LinkFrame &frame)
{
    std::vector<std::uint8_t> bytes(LinkFrameCodec::EncodedSize(frame));
    LinkFrameCodec::Encode(frame, bytes);
    return bytes;
}

LinkItem ItemOf(std::uint64_t sequence, std::uint8_t flags)
{
    LinkItem item;
    item.Sequence = item.Through = sequence;
    item.Flags = flags;
    return item;
}

// Returns a frame with everything that a frame can have.
StoredFrame FullFrame()
{
    static const std::vector<std::uint8_t> payload(300, 7);
    LinkFrame frame;
    frame.Check = 0x12345678;
    frame.SenderLife = 0xfedcba9876543210;
    frame.ReceiverLife = 5ULL << 32;
    frame.Clock = 0xabcdef01;
    frame.Time = 123456789000;
    frame.Echo = {0x11223344, 987654321000, 5000};
    frame.Ask = true;
    LinkAck &ack = frame.Acks.emplace_back();
    ack.Link = 3;
    ack.Open = true;
    ack.Oldest = 60;
    ack.Cumulative = 70;
    for (std::uint64_t i = 60; i <= 70; ++i)
    {
        OutcomeHistory::Assign(i % 4 == 0 ? ack.Refused : ack.Delivered, i, i % 3 != 0);
    }
    ack.Held[0] = 0x8000000000000001;
    ack.Held[2] = 0x100;
    ack.Credit = 77;
    frame.Acks.emplace_back().Link = 9;
    frame.HasData = true;
    frame.Data.Link = 200;
    frame.Data.Queue = "Orders";
    frame.Data.Oldest = 1000;
    LinkItem &whole =
        frame.Data.Items.emplace_back(ItemOf(1000, LinkFlagFirst | LinkFlagLast | LinkFlagRedelivered));
    whole.TypeNumber = 4;
    whole.Type = "Uav::Goto";
    whole.TtlLeft = 1500000;
    whole.Payload = payload;
    LinkItem &skip = frame.Data.Items.emplace_back(ItemOf(1005, LinkFlagSkip));
    skip.Through = 1100;
    LinkItem &first = frame.Data.Items.emplace_back(ItemOf(1101, LinkFlagFirst));
    first.Size = 500;
    first.Payload = std::span(payload).first(200);
    frame.Data.Items.emplace_back(ItemOf(1102, LinkFlagLast)).Payload = payload;
    return StoredFrame(frame);
}

TEST(LinkFrameCodec, GivesBackWhatWasPutIn)
{
    const StoredFrame stored = FullFrame();
    const LinkFrame frame = stored.View();
    const std::vector<std::uint8_t> bytes = Encoded(frame);
    LinkFrame decoded;
    ASSERT_TRUE(LinkFrameCodec::Decode(bytes, decoded));
    EXPECT_EQ(decoded.Check, frame.Check);
    EXPECT_EQ(decoded.SenderLife, frame.SenderLife);
    EXPECT_EQ(decoded.ReceiverLife, frame.ReceiverLife);
    EXPECT_EQ(decoded.Clock, frame.Clock);
    EXPECT_EQ(decoded.Time, frame.Time);
    EXPECT_EQ(decoded.Echo.Clock, frame.Echo.Clock);
    EXPECT_EQ(decoded.Echo.Time, frame.Echo.Time);
    EXPECT_EQ(decoded.Echo.HeldFor, frame.Echo.HeldFor);
    EXPECT_TRUE(decoded.Ask);
    ASSERT_EQ(decoded.Acks.size(), 2U);
    EXPECT_EQ(decoded.Acks[0].Link, 3U);
    EXPECT_EQ(decoded.Acks[0].Cumulative, 70U);
    EXPECT_EQ(decoded.Acks[0].Oldest, 60U);
    EXPECT_EQ(decoded.Acks[0].Delivered, frame.Acks[0].Delivered);
    EXPECT_EQ(decoded.Acks[0].Refused, frame.Acks[0].Refused);
    EXPECT_EQ(decoded.Acks[0].Held, frame.Acks[0].Held);
    EXPECT_EQ(decoded.Acks[0].Credit, 77U);
    EXPECT_EQ(decoded.Acks[1].Link, 9U);
    EXPECT_FALSE(decoded.Acks[1].Open);
    EXPECT_EQ(decoded.Data.Link, 200U);
    EXPECT_EQ(decoded.Data.Queue, "Orders");
    EXPECT_EQ(decoded.Data.Oldest, 1000U);
    ASSERT_EQ(decoded.Data.Items.size(), frame.Data.Items.size());
    for (std::size_t i = 0; i < frame.Data.Items.size(); ++i)
    {
        const LinkItem &put = frame.Data.Items[i];
        const LinkItem &got = decoded.Data.Items[i];
        EXPECT_EQ(got.Sequence, put.Sequence);
        EXPECT_EQ(got.Through, put.Through);
        EXPECT_EQ(got.Flags, put.Flags);
        EXPECT_EQ(got.TtlLeft, put.TtlLeft);
        EXPECT_EQ(got.TypeNumber, put.TypeNumber);
        EXPECT_EQ(got.Type, put.Type);
        EXPECT_EQ(got.Size, put.Size);
        EXPECT_TRUE(
            std::equal(got.Payload.begin(), got.Payload.end(), put.Payload.begin(), put.Payload.end()));
    }
}

TEST(LinkFrameCodec, CutsTimesSoThatNothingSeemsYounger)
{
    StoredFrame stored = FullFrame();
    stored.Fields.Time += 999;
    stored.Fields.Echo.Time += 999;
    stored.Fields.Echo.HeldFor += 999;
    stored.Items[0].Fields.TtlLeft += 999;
    const std::vector<std::uint8_t> bytes = Encoded(stored.View());
    LinkFrame decoded;
    ASSERT_TRUE(LinkFrameCodec::Decode(bytes, decoded));
    EXPECT_EQ(decoded.Time, 123456789000);
    EXPECT_EQ(decoded.Echo.Time, 987654321000);
    EXPECT_EQ(decoded.Echo.HeldFor, 5000);
    EXPECT_EQ(decoded.Data.Items[0].TtlLeft, 1500000);
}

TEST(LinkFrameCodec, ASmallMessageToWhoKnowsAllCostsLittle)
{
    const std::vector<std::uint8_t> payload(32, 1);
    LinkFrame frame;
    frame.Short = true;
    frame.Time = LinkTime(100h).count();
    frame.Echo = {1, LinkTime(50h).count(), LinkTime(1s).count()};
    frame.HasData = true;
    frame.Data.Link = 1;
    frame.Data.Oldest = 100000;
    LinkItem &item = frame.Data.Items.emplace_back(ItemOf(100000, LinkFlagFirst | LinkFlagLast));
    item.Payload = payload;
    EXPECT_EQ(LinkFrameCodec::EncodedSize(frame) - payload.size(), 25U);
}

TEST(LinkFrameCodec, AThousandDeliveredPartsAreOneRun)
{
    LinkFrame frame;
    frame.Clock = 1;
    LinkAck &ack = frame.Acks.emplace_back();
    ack.Link = 1;
    ack.Open = true;
    ack.Oldest = 1;
    ack.Cumulative = LinkWindowParts;
    ack.Delivered.fill(~0ULL);
    EXPECT_LE(LinkFrameCodec::AckSize(ack), 9U);
}

TEST(LinkFrameCodec, RefusesWhatIsCutShort)
{
    const std::vector<std::uint8_t> bytes = Encoded(FullFrame().View());
    LinkFrame decoded;
    for (std::size_t size = 0; size < bytes.size(); ++size)
    {
        EXPECT_FALSE(LinkFrameCodec::Decode(std::span(bytes).first(size), decoded)) << size;
    }
}

TEST(LinkFrameCodec, RefusesWhatGoesOnAfterTheEnd)
{
    std::vector<std::uint8_t> bytes = Encoded(FullFrame().View());
    bytes.push_back(0);
    LinkFrame decoded;
    EXPECT_FALSE(LinkFrameCodec::Decode(bytes, decoded));
}

TEST(LinkFrameCodec, RefusesAnotherVersion)
{
    std::vector<std::uint8_t> bytes = Encoded(FullFrame().View());
    ++bytes[0];
    LinkFrame decoded;
    EXPECT_FALSE(LinkFrameCodec::Decode(bytes, decoded));
}

// Bytes that decode can be encoded again and mean the same. Nothing reads beyond the end (the sanitizers
// see it).
TEST(LinkFrameCodec, DamagedBytesDoNoHarm)
{
    const std::vector<std::uint8_t> good = Encoded(FullFrame().View());
    std::mt19937 random(1);
    std::size_t decodable = 0;
    for (int i = 0; i < 200000; ++i)
    {
        std::vector<std::uint8_t> bytes(good);
        for (unsigned changes = 1 + random() % 4; changes > 0; --changes)
        {
            bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        }
        bytes.resize(random() % 4 == 0 ? random() % bytes.size() : bytes.size());
        LinkFrame frame;
        if (!LinkFrameCodec::Decode(bytes, frame))
        {
            continue;
        }
        ++decodable;
        ASSERT_LE(frame.Data.Items.size(), bytes.size());
        const std::vector<std::uint8_t> again = Encoded(frame);
        LinkFrame same;
        ASSERT_TRUE(LinkFrameCodec::Decode(again, same));
        ASSERT_EQ(same.Data.Items.size(), frame.Data.Items.size());
        ASSERT_EQ(Encoded(same), again);
    }
    EXPECT_GT(decodable, 1000U);
}

TEST(LinkFrameCodec, RandomBytesDoNoHarm)
{
    std::mt19937 random(2);
    for (int i = 0; i < 100000; ++i)
    {
        std::vector<std::uint8_t> bytes(random() % 200);
        for (std::uint8_t &byte : bytes)
        {
            byte = static_cast<std::uint8_t>(random());
        }
        if (!bytes.empty())
        {
            bytes[0] = LinkVersion;
        }
        LinkFrame frame;
        LinkFrameCodec::Decode(bytes, frame);
    }
}

}  // namespace
}  // namespace Rabit::Test
