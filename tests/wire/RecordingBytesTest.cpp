// A recording with one message, without compression: other versions of zstd may pack otherwise.
#include <gtest/gtest.h>
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/McapWriter.h>
#include <rabit/mcap/MessageCursor.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "Hex.h"
#include "MemoryFile.h"
#include "recording/replay/ReplayPlan.h"

namespace Rabit::Test
{
namespace
{

using namespace Mcap;

constexpr const char *FileBytes =
    "894d434150300d0a0118000000000000000500000072616269740b0000007261\n"
    "62697420302e312e300c31000000000000000a00000072616269742e6e6f6465\n"
    "1f00000006000000646f6d61696e0100000037040000006e6f64650400000075\n"
    "61763106f00000000000000002002a36fe9c971702002a36fe9c9717c8000000\n"
    "00000000de5707dd00000000c800000000000000032b00000000000000010009\n"
    "0000005561763a3a506f7365060000006f6d6769646c0e0000006d6f64756c65\n"
    "20556176207b7d3b0464000000000000000000010009000000756176312f506f\n"
    "736503000000636472480000000a00000072616269742e6b696e640600000070\n"
    "6f737465640a00000072616269742e6e6f646504000000756176310900000072\n"
    "616269742e716f730900000074656c656d65747279051e000000000000000000\n"
    "0300000002002a36fe9c971701002a36fe9c971700010000c0ffee0107160000\n"
    "000000000000001000000002002a36fe9c9717a1000000000000000f04000000\n"
    "0000000000000000032b000000000000000100090000005561763a3a506f7365\n"
    "060000006f6d6769646c0e0000006d6f64756c6520556176207b7d3b04640000\n"
    "00000000000000010009000000756176312f506f736503000000636472480000\n"
    "000a00000072616269742e6b696e6406000000706f737465640a000000726162\n"
    "69742e6e6f646504000000756176310900000072616269742e716f7309000000\n"
    "74656c656d657472790b38000000000000000100000000000000010001000000\n"
    "00000000010000000100000002002a36fe9c971702002a36fe9c97170a000000\n"
    "00000100000000000000084a0000000000000002002a36fe9c971702002a36fe\n"
    "9c97176300000000000000f9000000000000000a00000000005c010000000000\n"
    "001f0000000000000000000000c800000000000000c8000000000000000d1e00\n"
    "00000000000029000000000000003a000000000000000a00000072616269742e\n"
    "6e6f64650e110000000000000003880100000000000034000000000000000e11\n"
    "0000000000000004bc010000000000006d000000000000000e11000000000000\n"
    "000b290200000000000041000000000000000e1100000000000000086a020000\n"
    "0000000053000000000000000e11000000000000000dbd020000000000002700\n"
    "0000000000000214000000000000008801000000000000e40200000000000030\n"
    "3b393b894d434150300d0a";

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
    EXPECT_EQ(ValueOf(MetadataOf(contents, "rabit.node"), "domain"), "7");
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

TEST(RecordingBytes, AreReplayedAsThePostsOfTheirNode)
{
    MemoryFile file(BytesOf(FileBytes));
    const Contents contents = ReadContents(file);
    const Replay::ReplayPlan plan = Replay::PlanReplay({&contents}, {});
    EXPECT_EQ(plan.Domains, std::set<std::string>{"7"});
    ASSERT_EQ(plan.Streams.size(), 1U);
    const Replay::ReplayStream &stream = plan.Streams.front();
    EXPECT_EQ(stream.What, Replay::ReplayStream::Kind::Message);
    EXPECT_EQ(stream.Node, "uav1");
    EXPECT_EQ(stream.Name, "Pose");
    EXPECT_EQ(stream.Type, "Uav::Pose");
    EXPECT_EQ(stream.Recorder, "uav1");
    EXPECT_EQ(stream.Qos, "telemetry");
}

TEST(RecordingBytes, AreTheRecordedOnes)
{
    MemoryFile file;
    McapWriter writer(file, {.Library = "rabit 0.1.0", .Profile = "rabit", .Compresses = false});
    const std::uint16_t schema = writer.AddSchema("Uav::Pose", "omgidl", "module Uav {};");
    const auto channel =
        writer.AddChannel(schema, "uav1/Pose", "cdr",
                          {{"rabit.kind", "posted"}, {"rabit.node", "uav1"}, {"rabit.qos", "telemetry"}});
    ASSERT_TRUE(channel.has_value());
    ASSERT_TRUE(writer.AddMetadata({"rabit.node", {{"node", "uav1"}, {"domain", "7"}}}));
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
