#include <gtest/gtest.h>
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/McapWriter.h>
#include <rabit/mcap/MessageCursor.h>

#include <algorithm>
#include <stdexcept>

#include "MemoryFile.h"
#include "SmallRecording.h"
#include "recording/mcap/Crc32.h"

namespace
{

using namespace Rabit::Mcap;

Bytes BytesOf(const std::string &text)
{
    return {text.begin(), text.end()};
}

TEST(Crc32, IsThatOfZlib)
{
    EXPECT_EQ(Crc32(BytesOf("123456789")), 0xCBF43926U);
    EXPECT_EQ(Crc32({}), 0U);
    EXPECT_EQ(Crc32(BytesOf("The quick brown fox jumps over the lazy dog")), 0x414FA339U);
}

TEST(Crc32, ContinuesWhereItWas)
{
    const Bytes bytes = BytesOf("The quick brown fox jumps over the lazy dog, and back again at once.");
    for (std::size_t cut = 0; cut <= bytes.size(); ++cut)
    {
        EXPECT_EQ(Crc32(ByteView(bytes).subspan(cut), Crc32(ByteView(bytes).first(cut))), Crc32(bytes));
    }
}

TEST(McapWriter, GivesBackAllThatWasWritten)
{
    for (const bool compresses : {true, false})
    {
        SmallRecording recording(compresses);
        const Contents contents = ReadContents(recording.File);
        ASSERT_TRUE(contents.IsIndexed);
        EXPECT_TRUE(contents.Problems.empty());
        EXPECT_EQ(contents.Header.Library, "rabit test");
        EXPECT_EQ(contents.Schemas.at(1).Encoding, "omgidl");
        EXPECT_EQ(contents.Channels.at(0).Metadata.at("node"), "uav1");
        EXPECT_EQ(contents.Statistics.MessageCount, recording.Messages.size());
        EXPECT_EQ(contents.Statistics.StartTime, 1000U);
        EXPECT_EQ(contents.Statistics.EndTime, 1011U);
        EXPECT_EQ(contents.Statistics.ChannelMessageCounts.at(1), 3U);
        ASSERT_EQ(contents.MetadataRecords.size(), 1U);
        EXPECT_EQ(contents.MetadataRecords[0].Values.at("node"), "uav1");
        ASSERT_EQ(contents.Attachments.size(), 1U);
        EXPECT_EQ(contents.Attachments[0].Name, "uav1.yaml");

        MessageCursor cursor(recording.File, contents, {});
        for (const SmallRecording::Sent &sent : recording.Messages)
        {
            const auto message = cursor.Next();
            ASSERT_TRUE(message);
            EXPECT_EQ(contents.Channels.at(message->ChannelId).Topic, sent.Topic);
            EXPECT_EQ(message->LogTime, sent.LogTime);
            EXPECT_EQ(message->PublishTime, sent.LogTime - 1);
            EXPECT_EQ(Bytes(message->Data.begin(), message->Data.end()), sent.Data);
        }
        EXPECT_FALSE(cursor.Next());
        EXPECT_TRUE(cursor.Problems().empty());
    }
}

TEST(McapWriter, CompressesSmallMessagesButNotLargeOnes)
{
    SmallRecording recording;
    for (const ChunkIndex &chunk : ReadContents(recording.File).Chunks)
    {
        EXPECT_EQ(chunk.Compression, chunk.UncompressedSize > McapWriter::LargeMessage ? "" : "zstd");
    }
}

TEST(McapWriter, WritesNothingMoreAfterTheDiskIsFull)
{
    SmallRecording whole;
    MemoryFile file;
    file.Room = 200;
    McapWriter writer(file, {"rabit test", "", false});
    const std::uint16_t channel = *writer.AddChannel(0, "a", "json");
    const Bytes data(300);
    EXPECT_TRUE(writer.Add({channel, 0, 1, 1, data}));
    EXPECT_FALSE(writer.FinishChunks());
    EXPECT_FALSE(writer.IsGood());
    file.Room = 1000000;
    EXPECT_FALSE(writer.Add({channel, 0, 2, 2, data}));
    EXPECT_FALSE(writer.Finish());
    EXPECT_EQ(file.Content.size(), 200U);
}

TEST(McapWriter, RefusesAChannelThatItDoesNotHave)
{
    MemoryFile file;
    McapWriter writer(file, {});
    EXPECT_THROW(writer.Add({0, 0, 1, 1, {}}), std::invalid_argument);
    EXPECT_THROW(writer.AddChannel(1, "a", "json"), std::invalid_argument);
}

TEST(McapWriter, RefusesMessagesLargerThanReadersTake)
{
    MemoryFile file;
    McapWriter writer(file, {});
    const std::uint16_t channel = *writer.AddChannel(0, "a", "json");
    EXPECT_FALSE(writer.Add({channel, 0, 1, 1, Bytes(McapWriter::LargestMessage + 1)}));
    EXPECT_TRUE(writer.IsGood());
    EXPECT_TRUE(writer.Finish());
    EXPECT_EQ(ReadContents(file).Statistics.MessageCount, 0U);
}

TEST(McapWriter, BeginsAChunkWhenOneIsFull)
{
    MemoryFile file;
    McapWriter writer(file, {"", "", false});
    const std::uint16_t channel = *writer.AddChannel(0, "a", "json");
    const Bytes data(1000);
    for (std::uint64_t time = 0; time < 3000; ++time)
    {
        writer.Add({channel, 0, time, time, data});
    }
    writer.Finish();
    const Contents contents = ReadContents(file);
    ASSERT_EQ(contents.Chunks.size(), 3U);
    EXPECT_LE(contents.Chunks[0].UncompressedSize, McapWriter::ChunkSize + 100);
    EXPECT_EQ(contents.Statistics.ChunkCount, 3U);
}

// A reader of a file that grows takes what it has for complete up to the chunk before the last.
TEST(McapWriter, WritesSmallMessagesBeforeLargeOnesThatCameAfterThem)
{
    MemoryFile file;
    McapWriter writer(file, {"", "", false});
    const std::uint16_t channel = *writer.AddChannel(0, "a", "json");
    const Bytes large(McapWriter::LargeChunkSize / 2);
    for (std::uint64_t time = 1; time <= 6; ++time)
    {
        writer.Add({channel, 0, 10 * time, 10 * time, Bytes(10)});
        writer.Add({channel, 0, 10 * time + 5, 10 * time + 5, large});
    }
    writer.Finish();
    std::uint64_t newest = 0;
    for (const ChunkIndex &chunk : ReadContents(file).Chunks)
    {
        if (chunk.UncompressedSize < McapWriter::LargeMessage)
        {
            EXPECT_GT(chunk.StartTime, newest)
                << "large messages that came after these were written before them";
        }
        newest = std::max(newest, chunk.EndTime);
    }
}

}  // namespace
