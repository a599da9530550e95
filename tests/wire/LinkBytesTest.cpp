// Frames of the links: long, short, with data, with acknowledgements; and the parts of types' texts that
// share their topic.
#include <gtest/gtest.h>
#include <rabit/gateway/links/LinkCheck.h>
#include <rabit/gateway/links/LinkFrameCodec.h>

#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "Hex.h"
#include "wire/LinkSampleCodec.h"
#include "wire/NodeReports.h"
#include "wire/TypeFrames.h"

namespace Rabit::Test
{
namespace
{

constexpr const char *HelloBytes = "0400785634121032547698badcfe000000000000000001efcdab959aef3a";
constexpr const char *LongFrameBytes =
    "041e785634121032547698badcfe000000000500000001efcdab959aef3a4433\n"
    "2211b1d1f9d603050207460b09060904154d1201000000000000800000000000\n"
    "0000000001129103064f7264657273e807043edc0b041a5561763a3a476f746f\n"
    "403031323334353637383961626364656605c0ffee010241045f0400f40303c0\n"
    "ffee0805c0ffee0102";
constexpr const char *ShortFrameBytes =
    "040d2143658715cd5b07780ae305050105070105e807000229014c010105c0ff\n"
    "ee0102";
constexpr const char *HelloSampleBytes =
    "000100021e0000000400785634121032547698badcfe000000000000000001ef\n"
    "cdab959aef3a0000";
constexpr const char *TypePartBytes = "540000008877665544332211e803000070110100c0ffee0102";
constexpr const char *ReportBytes = "e4abf64941436b01370a6c696e650a";

const std::vector<std::uint8_t> Payload = {0xc0, 0xff, 0xee, 0x01, 0x02};

LinkItem ItemOf(std::uint64_t sequence, std::uint8_t flags)
{
    LinkItem item;
    item.Sequence = item.Through = sequence;
    item.Flags = flags;
    return item;
}

LinkFrame Hello()
{
    LinkFrame frame;
    frame.Check = 0x12345678;
    frame.SenderLife = 0xfedcba9876543210;
    frame.Clock = 0xabcdef01;
    frame.Time = 123456789000;
    return frame;
}

// A long frame with everything that a frame can have.
LinkFrame LongFrame()
{
    LinkFrame frame = Hello();
    frame.ReceiverLife = 5ULL << 32;
    frame.Echo = {0x11223344, 987654321000, 5000};
    frame.Ask = true;
    LinkAck &ack = frame.Acks.emplace_back();
    ack.Link = 3;
    ack.Open = true;
    ack.Oldest = 60;
    ack.Cumulative = 70;
    ack.Delivered[0] = 0xb000000000000000;  // parts 60, 61 and 63
    ack.Delivered[1] = 0x7d;                // and 64, 66 to 70
    ack.Refused[0] = 0x4000000000000000;    // part 62
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
    whole.Type = "Uav::Goto@0123456789abcdef";
    whole.TtlLeft = 1500000;
    whole.Payload = Payload;
    LinkItem &skip = frame.Data.Items.emplace_back(ItemOf(1005, LinkFlagSkip));
    skip.Through = 1100;
    LinkItem &first = frame.Data.Items.emplace_back(ItemOf(1101, LinkFlagFirst));
    first.Size = 500;
    first.Payload = std::span(Payload).first(3);
    frame.Data.Items.emplace_back(ItemOf(1102, LinkFlagLast)).Payload = Payload;
    return frame;
}

// The usual small message between nodes that know each other.
LinkFrame ShortFrame()
{
    LinkFrame frame;
    frame.Short = true;
    frame.Check = 0x87654321;
    frame.Time = 123456789000;
    frame.Echo = {1, 98765432000, 5000};
    frame.HasData = true;
    frame.Data.Link = 1;
    frame.Data.Oldest = 41;
    LinkItem &item = frame.Data.Items.emplace_back(ItemOf(42, LinkFlagFirst | LinkFlagLast));
    item.TypeNumber = 1;
    item.Payload = Payload;
    LinkAck &ack = frame.Acks.emplace_back();
    ack.Link = 2;
    ack.Open = true;
    ack.Oldest = ack.Cumulative = 7;
    ack.Delivered[0] = 0x80;
    ack.Credit = 1000;
    return frame;
}

std::vector<std::uint8_t> Encoded(const LinkFrame &frame)
{
    std::vector<std::uint8_t> bytes(LinkFrameCodec::EncodedSize(frame));
    LinkFrameCodec::Encode(frame, bytes);
    return bytes;
}

// All fields that are on the wire. A short frame leaves out the clock of the echo.
std::string TextOf(const LinkFrame &frame)
{
    std::ostringstream text;
    text << "short " << frame.Short << " check " << frame.Check << " lives " << frame.SenderLife << ' '
         << frame.ReceiverLife << " clock " << frame.Clock << " time " << frame.Time << " echo "
         << (frame.Short ? 0 : frame.Echo.Clock) << ' ' << frame.Echo.Time << ' ' << frame.Echo.HeldFor
         << " ask " << frame.Ask;
    for (const LinkAck &ack : frame.Acks)
    {
        text << "\nack " << ack.Link << " open " << ack.Open << " parts " << ack.Oldest << ' '
             << ack.Cumulative << " credit " << ack.Credit;
        for (const LinkBitmap *bits : {&ack.Delivered, &ack.Refused, &ack.Held})
        {
            text << " bits " << (*bits)[0] << ' ' << (*bits)[1] << ' ' << (*bits)[2];
        }
    }
    if (frame.HasData)
    {
        text << "\ndata " << frame.Data.Link << " queue " << frame.Data.Queue << " oldest "
             << frame.Data.Oldest;
        for (const LinkItem &item : frame.Data.Items)
        {
            text << "\nitem " << item.Sequence << ' ' << item.Through << " flags "
                 << static_cast<int>(item.Flags) << " ttl " << item.TtlLeft << " type " << item.TypeNumber
                 << ' ' << item.Type << " size " << item.Size << " payload " << HexOf(item.Payload);
        }
    }
    return text.str();
}

std::string TextOf(const std::vector<std::uint8_t> &bytes)
{
    LinkFrame frame;
    return LinkFrameCodec::Decode(bytes, frame) ? TextOf(frame) : "not a frame";
}

TEST(LinkBytes, OfAHelloAreAccepted)
{
    EXPECT_EQ(TextOf(BytesOf(HelloBytes)), TextOf(Hello()));
}

TEST(LinkBytes, OfAHelloAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(Encoded(Hello())), HelloBytes);
}

TEST(LinkBytes, OfALongFrameAreAccepted)
{
    EXPECT_EQ(TextOf(BytesOf(LongFrameBytes)), TextOf(LongFrame()));
}

TEST(LinkBytes, OfALongFrameAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(Encoded(LongFrame())), LongFrameBytes);
}

TEST(LinkBytes, OfAShortFrameAreAccepted)
{
    EXPECT_EQ(TextOf(BytesOf(ShortFrameBytes)), TextOf(ShortFrame()));
}

TEST(LinkBytes, OfAShortFrameAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(Encoded(ShortFrame())), ShortFrameBytes);
}

TEST(LinkBytes, OfASampleAreOpened)
{
    const std::vector<std::uint8_t> sample = BytesOf(HelloSampleBytes);
    std::span<const std::uint8_t> frame;
    ASSERT_TRUE(OpenLinkSample(sample, frame));
    EXPECT_EQ(HexOf(frame), HelloBytes);
}

TEST(LinkBytes, OfASampleAreTheRecordedOnes)
{
    const LinkFrame frame = Hello();
    const LinkSampleEncoder encoder(frame);
    std::vector<std::uint8_t> bytes(encoder.EncodedSize());
    ASSERT_TRUE(encoder.Encode(bytes));
    EXPECT_EQ(HexOf(bytes), HelloSampleBytes);
}

// Both sides compute the check of a frame.
TEST(LinkBytes, ChecksAreTheRecordedOnes)
{
    EXPECT_EQ(LinkCheck::OfName("uav2"), 2978576675U);
    EXPECT_EQ(LinkCheck::OfShort("uav2", 0x0123456789abcdef, 5ULL << 32, 7, 0x11223344), 4210992347U);
}

TEST(LinkBytes, OfAPartOfATypesTextAreAccepted)
{
    const std::vector<std::uint8_t> bytes = BytesOf(TypePartBytes);
    const auto part = TypeFrames::Decode(bytes);
    ASSERT_TRUE(part.has_value());
    EXPECT_EQ(part->Definition, 0x1122334455667788U);
    EXPECT_EQ(part->First, 1000U);
    EXPECT_EQ(part->Of, 70000U);
    EXPECT_EQ(HexOf(part->Bytes), HexOf(Payload));
}

TEST(LinkBytes, OfAPartOfATypesTextAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(TypeFrames::Encode(
                  {.Definition = 0x1122334455667788, .First = 1000, .Of = 70000, .Bytes = Payload})),
              TypePartBytes);
}

TEST(LinkBytes, OfAReportAreTheRecordedOnes)
{
    const std::string sealed = NodeReports::Sealed("7\nline\n");
    EXPECT_EQ(HexOf(std::vector<std::uint8_t>(sealed.begin(), sealed.end())), ReportBytes);
    EXPECT_EQ(NodeReports::Opened(sealed), "7\nline\n");
    EXPECT_EQ(NodeReports::NameOf(NodeReports::Kind::LinesFrom, 9), 0x5265700400000009U);
    EXPECT_EQ(NodeReports::NameOf(NodeReports::Kind::Agreement), 0x5265700700000000U);
}

}  // namespace
}  // namespace Rabit::Test
