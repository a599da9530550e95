// A link frame as a sample: it has the bytes of the generated class, and damaged bytes are refused.
#include <gtest/gtest.h>
#include <rabit/gateway/links/LinkFrameCodec.h>

#include <vector>

#include "gateway.idl.h"
#include "wire/GatewayTopics.h"
#include "wire/LinkSampleCodec.h"
#include "wire/LinkTopics.h"

namespace Rabit
{
namespace
{

// Returns a hello with data. Payloads of all lengths modulo 4 are tried.
LinkFrame FrameWith(const std::vector<std::uint8_t> &payload)
{
    LinkFrame frame;
    frame.SenderLife = 5ULL << 32;
    frame.ReceiverLife = 6ULL << 32;
    frame.Clock = 7;
    frame.Time = 8000;
    frame.HasData = true;
    frame.Data.Link = 1;
    frame.Data.Queue = "Orders";
    frame.Data.Oldest = 3;
    LinkItem &item = frame.Data.Items.emplace_back();
    item.Sequence = item.Through = 3;
    item.Flags = LinkFlagFirst | LinkFlagLast;
    item.Type = "Uav::Goto";
    item.Payload = payload;
    return frame;
}

std::vector<std::uint8_t> SampleOf(const LinkFrame &frame)
{
    const LinkSampleEncoder encoder(frame);
    std::vector<std::uint8_t> bytes(encoder.EncodedSize());
    EXPECT_TRUE(encoder.Encode(bytes));
    return bytes;
}

TEST(LinkSampleCodec, HasTheBytesOfTheGeneratedClass)
{
    const MessageType &type = GatewayTopics::TypeOf<Gateway::LinkSample>();
    for (std::size_t size = 0; size < 9; ++size)
    {
        const std::vector<std::uint8_t> payload(size, 0x5a);
        const LinkFrame frame = FrameWith(payload);
        Gateway::LinkSample sample;
        sample.frame.resize(LinkFrameCodec::EncodedSize(frame));
        LinkFrameCodec::Encode(frame, sample.frame);
        std::vector<std::uint8_t> expected(type.SerializedSize(sample));
        ASSERT_EQ(type.Serialize(sample, expected), expected.size());
        EXPECT_EQ(SampleOf(frame), expected) << size;
    }
}

TEST(LinkSampleCodec, OpensWhatItMade)
{
    const std::vector<std::uint8_t> payload(5, 1);
    const std::vector<std::uint8_t> bytes = SampleOf(FrameWith(payload));
    std::span<const std::uint8_t> frame;
    ASSERT_TRUE(OpenLinkSample(bytes, frame));
    LinkFrame decoded;
    ASSERT_TRUE(LinkFrameCodec::Decode(frame, decoded));
    EXPECT_EQ(decoded.Data.Queue, "Orders");
    EXPECT_EQ(frame[0], LinkVersion) << "the version comes first";
}

TEST(LinkSampleCodec, RefusesWhatIsCutShortOrHasMoreThanItSays)
{
    const std::vector<std::uint8_t> payload(5, 1);
    std::vector<std::uint8_t> bytes = SampleOf(FrameWith(payload));
    std::span<const std::uint8_t> frame;
    for (std::size_t size = 0; size + 4 <= bytes.size(); ++size)
    {
        EXPECT_FALSE(OpenLinkSample(std::span(bytes).first(size), frame)) << size;
    }
    bytes.resize(bytes.size() + 8);
    EXPECT_FALSE(OpenLinkSample(bytes, frame));
}

TEST(LinkSampleCodec, RefusesABufferOfAnotherSize)
{
    const std::vector<std::uint8_t> payload(5, 1);
    const LinkFrame frame = FrameWith(payload);
    const LinkSampleEncoder encoder(frame);
    std::vector<std::uint8_t> bytes(encoder.EncodedSize() + 1);
    EXPECT_FALSE(encoder.Encode(bytes));
}

// A frame may go by any path, so all frames leave room for the keys of one.
TEST(LinkTopics, LeaveRoomForKeysIfAnyPathHasThem)
{
    GatewayConfig config;
    EXPECT_EQ(LargestLinkFrameOf(config), LargestLinkFrame(config.MaxDatagram, false));
    config.Paths = {{.Name = "mesh"}, {.Name = "modem"}};
    EXPECT_EQ(LargestLinkFrameOf(config), LargestLinkFrame(config.MaxDatagram, false));
    config.Paths[1].Security.emplace();
    EXPECT_EQ(LargestLinkFrameOf(config), LargestLinkFrame(config.MaxDatagram, true));
    config.Paths.clear();
    config.Security.emplace();
    EXPECT_EQ(LargestLinkFrameOf(config), LargestLinkFrame(config.MaxDatagram, true));
}

}  // namespace
}  // namespace Rabit
