// A recording with one message, without compression: other versions of zstd may pack otherwise.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "Hex.h"
#include "MemoryFile.h"
#include "recording/mcap/McapContents.h"
#include "recording/mcap/McapWriter.h"
#include "recording/mcap/MessageCursor.h"

namespace Rabit::Test
{
namespace
{

using namespace Mcap;

constexpr const char *FileBytes =
    "894d434150300d0a0118000000000000000500000072616269740b0000007261\n"
    "62697420302e312e300c22000000000000000a00000072616269742e6e6f6465\n"
    "10000000040000006e6f6465040000007561763106c20000000000000002002a\n"
    "36fe9c971702002a36fe9c97179a000000000000007c30327f000000009a0000\n"
    "0000000000032b000000000000000100090000005561763a3a506f7365060000\n"
    "006f6d6769646c0e0000006d6f64756c6520556176207b7d3b04360000000000\n"
    "00000000010009000000756176312f506f7365030000006364721a0000000900\n"
    "000072616269742e716f730900000074656c656d65747279051e000000000000\n"
    "0000000300000002002a36fe9c971701002a36fe9c971700010000c0ffee0107\n"
    "160000000000000000001000000002002a36fe9c971773000000000000000f04\n"
    "0000000000000000000000032b000000000000000100090000005561763a3a50\n"
    "6f7365060000006f6d6769646c0e0000006d6f64756c6520556176207b7d3b04\n"
    "36000000000000000000010009000000756176312f506f736503000000636472\n"
    "1a0000000900000072616269742e716f730900000074656c656d657472790b38\n"
    "0000000000000001000000000000000100010000000000000001000000010000\n"
    "0002002a36fe9c971702002a36fe9c97170a0000000000010000000000000008\n"
    "4a0000000000000002002a36fe9c971702002a36fe9c97175400000000000000\n"
    "cb000000000000000a00000000001f010000000000001f000000000000000000\n"
    "00009a000000000000009a000000000000000d1e000000000000002900000000\n"
    "0000002b000000000000000a00000072616269742e6e6f64650e110000000000\n"
    "0000034b0100000000000034000000000000000e1100000000000000047f0100\n"
    "00000000003f000000000000000e11000000000000000bbe0100000000000041\n"
    "000000000000000e110000000000000008ff0100000000000053000000000000\n"
    "000e11000000000000000d520200000000000027000000000000000214000000\n"
    "000000004b0100000000000079020000000000001f981113894d434150300d0a";

const Bytes Data = {0x00, 0x01, 0x00, 0x00, 0xc0, 0xff, 0xee, 0x01};

TEST(RecordingBytes, AreReadAsWhatWasWritten)
{
    MemoryFile file(BytesOf(FileBytes));
    const Contents contents = ReadContents(file);
    EXPECT_TRUE(contents.IsIndexed);
    EXPECT_TRUE(contents.Problems.empty());
    EXPECT_EQ(contents.Header.Profile, "rabit");
    EXPECT_EQ(contents.Header.Library, "rabit 0.1.0");
    EXPECT_EQ(contents.Schemas.at(1).Name, "Uav::Pose");
    EXPECT_EQ(contents.Schemas.at(1).Encoding, "omgidl");
    EXPECT_EQ(contents.Schemas.at(1).Data, "module Uav {};");
    EXPECT_EQ(contents.Channels.at(0).Topic, "uav1/Pose");
    EXPECT_EQ(contents.Channels.at(0).MessageEncoding, "cdr");
    EXPECT_EQ(ValueOf(contents.Channels.at(0).Metadata, "rabit.qos"), "telemetry");
    EXPECT_EQ(ValueOf(MetadataOf(contents, "rabit.node"), "node"), "uav1");
    MessageCursor cursor(file, contents, {});
    const auto message = cursor.Next();
    ASSERT_TRUE(message.has_value());
    EXPECT_EQ(message->ChannelId, 0U);
    EXPECT_EQ(message->Sequence, 3U);
    EXPECT_EQ(message->LogTime, 1'700'000'000'000'000'002U);
    EXPECT_EQ(message->PublishTime, 1'700'000'000'000'000'001U);
    EXPECT_EQ(HexOf(message->Data), HexOf(Data));
    EXPECT_FALSE(cursor.Next().has_value());
}

TEST(RecordingBytes, AreTheRecordedOnes)
{
    MemoryFile file;
    McapWriter writer(file, {.Library = "rabit 0.1.0", .Profile = "rabit", .Compresses = false});
    const std::uint16_t schema = writer.AddSchema("Uav::Pose", "omgidl", "module Uav {};");
    const auto channel = writer.AddChannel(schema, "uav1/Pose", "cdr", {{"rabit.qos", "telemetry"}});
    ASSERT_TRUE(channel.has_value());
    ASSERT_TRUE(writer.AddMetadata({"rabit.node", {{"node", "uav1"}}}));
    ASSERT_TRUE(writer.Add({.ChannelId = *channel,
                            .Sequence = 3,
                            .LogTime = 1'700'000'000'000'000'002,
                            .PublishTime = 1'700'000'000'000'000'001,
                            .Data = Data}));
    ASSERT_TRUE(writer.Finish());
    EXPECT_EQ(HexOf(file.Content), FileBytes);
}

}  // namespace
}  // namespace Rabit::Test
