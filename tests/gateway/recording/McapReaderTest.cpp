// Reading files that are truncated, damaged, or made with bad intent.
#include <gtest/gtest.h>
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/McapRecovery.h>
#include <rabit/mcap/MessageCursor.h>
#include <rabit/mcap/RecordCodec.h>
#include <rabit/mcap/RecordScanner.h>

#include <random>

#include "MemoryFile.h"
#include "SmallRecording.h"

namespace
{

using namespace Rabit::Mcap;

MemoryFile FirstOf(const SmallRecording &recording, std::size_t bytes)
{
    const auto begin = recording.File.Content.begin();
    return MemoryFile(Bytes(begin, begin + static_cast<std::ptrdiff_t>(bytes)));
}

std::size_t MessagesOf(MemoryFile &file, const Contents &contents)
{
    MessageCursor cursor(file, contents, {});
    std::size_t count = 0;
    while (cursor.Next())
    {
        ++count;
    }
    return count;
}

// Returns the number of messages that the first `bytes` bytes contain at least.
std::size_t WrittenBefore(const SmallRecording &recording, std::size_t bytes)
{
    std::size_t messages = 0;
    for (const SmallRecording::Mark &mark : recording.Marks)
    {
        messages = mark.Bytes <= bytes ? mark.Messages : messages;
    }
    return messages;
}

// Removes the checksums, so that they do not reveal the damage.
void WithoutChecksums(MemoryFile &file)
{
    constexpr std::size_t beforeCrcOfChunk = RecordHead + 24;
    constexpr std::size_t fromCrcOfSummary = Magic.size() + sizeof(std::uint32_t);
    for (const ChunkIndex &chunk : ReadContents(file).Chunks)
    {
        std::fill_n(file.Content.begin() + static_cast<std::ptrdiff_t>(chunk.Offset + beforeCrcOfChunk),
                    sizeof(std::uint32_t), std::uint8_t{0});
    }
    std::fill_n(file.Content.end() - static_cast<std::ptrdiff_t>(fromCrcOfSummary), sizeof(std::uint32_t),
                std::uint8_t{0});
    ASSERT_TRUE(ReadContents(file).IsIndexed);
}

// Every 7th offset: the pictures make the file large. The stock reader is tried with each offset of a
// smaller one.
TEST(McapReader, ReadsATruncatedFileUpToTheLastWholeRecord)
{
    const SmallRecording recording;
    for (std::size_t bytes = 0; bytes < recording.File.Content.size(); bytes += 7)
    {
        MemoryFile file = FirstOf(recording, bytes);
        const Contents contents = ReadContents(file);
        ASSERT_FALSE(contents.IsIndexed) << bytes;
        ASSERT_FALSE(contents.Problems.empty()) << bytes;
        ASSERT_LE(contents.GoodUntil, bytes);
        ASSERT_GE(MessagesOf(file, contents), WrittenBefore(recording, bytes)) << bytes;
    }
}

TEST(McapReader, RecoversATruncatedFileWithAnIndex)
{
    const SmallRecording recording;
    const SmallRecording::Mark mark = recording.Marks[recording.Marks.size() - 2];
    MemoryFile file = FirstOf(recording, mark.Bytes + 5);
    MemoryFile recovered;
    McapWriter writer(recovered, {"rabit test", "", true});
    const Recovered result = Recover(file, writer);
    EXPECT_TRUE(result.IsWritten);
    EXPECT_EQ(result.Messages, mark.Messages);
    EXPECT_EQ(result.LostMessages, 0U);
    ASSERT_EQ(result.Problems.size(), 1U);
    EXPECT_EQ(result.Problems[0].find("the file was not ended in order"), 0U) << result.Problems[0];
    const Contents contents = ReadContents(recovered);
    EXPECT_TRUE(contents.IsIndexed);
    EXPECT_EQ(contents.MetadataRecords.size(), 1U);
    EXPECT_EQ(contents.Attachments.size(), 1U);
    EXPECT_EQ(contents.Channels.at(0).Metadata.at("node"), "uav1");
    EXPECT_EQ(MessagesOf(recovered, contents), mark.Messages);
}

TEST(McapReader, LosesOnlyTheChunkThatIsDamaged)
{
    SmallRecording recording;
    const Contents before = ReadContents(recording.File);
    const ChunkIndex damaged = before.Chunks[2];
    recording.File.Content[damaged.Offset + damaged.Length - 1] ^= 1U;
    MemoryFile recovered;
    McapWriter writer(recovered, {});
    const Recovered result = Recover(recording.File, writer);
    ASSERT_EQ(result.Problems.size(), 1U);
    EXPECT_EQ(
        result.Problems[0].find("the chunk at byte " + std::to_string(damaged.Offset) + " cannot be read: "),
        0U)
        << result.Problems[0];
    EXPECT_GE(result.Messages, recording.Messages.size() - 3);
    EXPECT_LT(result.Messages, recording.Messages.size());
}

TEST(McapReader, FindsMessagesOfATimeAndOfSomeChannels)
{
    SmallRecording recording;
    const Contents contents = ReadContents(recording.File);
    MessageCursor::Selection selection;
    selection.From = 1004;
    selection.To = 1010;
    selection.Wants = [](std::uint16_t channel) { return channel == 1; };
    MessageCursor cursor(recording.File, contents, selection);
    EXPECT_EQ(cursor.Next()->LogTime, 1005U);
    EXPECT_EQ(cursor.Next()->LogTime, 1010U);
    EXPECT_FALSE(cursor.Next());
}

TEST(McapReader, SaysWhatIsNoMcapFile)
{
    MemoryFile file(Bytes(100, 'x'));
    const Contents contents = ReadContents(file);
    ASSERT_EQ(contents.Problems.size(), 1U);
    EXPECT_EQ(contents.Problems[0], "this is no MCAP file");
}

TEST(McapReader, RecoversMessagesOutsideOfChunks)
{
    MemoryFile file(Bytes(Magic.begin(), Magic.end()));
    Append(file.Content, Header{"", "another"});
    Append(file.Content, Channel{3, 0, "a", "json", {}});
    Append(file.Content, Message{3, 0, 7, 7, {}});
    Append(file.Content, Message{4, 0, 8, 8, {}});
    MemoryFile recovered;
    McapWriter writer(recovered, {});
    const Recovered result = Recover(file, writer);
    EXPECT_EQ(result.Messages, 1U);
    EXPECT_EQ(result.LostMessages, 1U);
}

// A few bytes that claim to be a gigabyte.
TEST(McapReader, RefusesAChunkThatIsTooLarge)
{
    MemoryFile file(Bytes(Magic.begin(), Magic.end()));
    Chunk chunk;
    chunk.UncompressedSize = std::uint64_t{1} << 30;
    chunk.Compression = "zstd";
    AppendChunkHead(file.Content, chunk);
    const Contents contents = ReadContents(file);
    ASSERT_EQ(contents.Problems.size(), 2U);
    EXPECT_NE(contents.Problems[0].find("larger than 256 MiB"), std::string::npos);
}

// A summary of a few kilobytes that would take a gigabyte.
TEST(McapReader, RefusesASummaryThatNamesOneLargeRecordAgainAndAgain)
{
    MemoryFile file(Bytes(Magic.begin(), Magic.end()));
    Append(file.Content, Header{"", "another"});
    MetadataIndex index{file.Content.size(), 0, "large"};
    Append(file.Content, Metadata{"large", {{"key", std::string(std::size_t{1} << 20, 'x')}}});
    index.Length = file.Content.size() - index.Offset;
    AppendDataEnd(file.Content);
    Footer footer;
    footer.SummaryStart = file.Content.size();
    Bytes summary;
    for (int i = 0; i < 1000; ++i)
    {
        Append(summary, index);
    }
    Append(summary, Statistics{});
    file.Content.insert(file.Content.end(), summary.begin(), summary.end());
    AppendFooter(file.Content, footer, summary);
    file.Content.insert(file.Content.end(), Magic.begin(), Magic.end());
    const Contents contents = ReadContents(file);
    EXPECT_FALSE(contents.IsIndexed);
    EXPECT_EQ(contents.MetadataRecords.size(), 1U);
}

// 5 MB of empty texts that would take 70 MB of memory.
TEST(McapReader, RefusesMetadataThatTakeFarMoreMemoryThanBytes)
{
    constexpr std::uint32_t count = 600'000;
    Bytes entries;
    for (std::uint32_t number = 0; number < count; ++number)
    {
        const auto byte = [number](unsigned at) { return static_cast<std::uint8_t>(number >> (8 * at)); };
        entries.insert(entries.end(), {3, 0, 0, 0, byte(0), byte(1), byte(2), 0, 0, 0, 0});
    }
    const auto size = [&entries](unsigned at)
    { return static_cast<std::uint8_t>(entries.size() >> (8 * at)); };
    Bytes metadata = {0, 0, 0, 0, size(0), size(1), size(2), size(3)};  // without a name
    metadata.insert(metadata.end(), entries.begin(), entries.end());
    EXPECT_FALSE(Read<Metadata>(metadata));
    Bytes channel = {1, 0, 0, 0, 0, 0, 0, 0};  // without a topic
    channel.insert(channel.end(), metadata.begin(), metadata.end());
    EXPECT_FALSE(Read<Channel>(channel));
}

TEST(McapReader, RecoversMetadataUpToABound)
{
    MemoryFile file(Bytes(Magic.begin(), Magic.end()));
    Append(file.Content, Header{"", "another"});
    for (const std::string name : {"first", "second"})
    {
        Append(file.Content, Metadata{name, {{"key", std::string(40U << 20, 'x')}}});
    }
    MemoryFile recovered;
    McapWriter writer(recovered, {});
    const Recovered result = Recover(file, writer);
    EXPECT_TRUE(result.IsWritten);
    EXPECT_EQ(result.Problems.size(), 2U);
    const Contents contents = ReadContents(recovered);
    EXPECT_TRUE(contents.IsIndexed);
    ASSERT_EQ(contents.MetadataRecords.size(), 1U);
    EXPECT_EQ(contents.MetadataRecords[0].Name, "first");
}

TEST(McapReader, KeepsTheHeaderIfASecondOneIsMalformed)
{
    MemoryFile file(Bytes(Magic.begin(), Magic.end()));
    Append(file.Content, Header{"", "another"});
    const Bytes malformed = {static_cast<std::uint8_t>(Opcode::Header), 1, 0, 0, 0, 0, 0, 0, 0, 0};
    file.Content.insert(file.Content.end(), malformed.begin(), malformed.end());
    EXPECT_EQ(ReadContents(file).Header.Library, "another");
}

// A file with these records in its summary, and nothing else.
MemoryFile WithSummary(const Bytes &records)
{
    MemoryFile file(Bytes(Magic.begin(), Magic.end()));
    Append(file.Content, Header{"", "another"});
    AppendDataEnd(file.Content);
    Footer footer;
    footer.SummaryStart = file.Content.size();
    Bytes summary = records;
    Append(summary, Statistics{});
    file.Content.insert(file.Content.end(), summary.begin(), summary.end());
    AppendFooter(file.Content, footer, summary);
    file.Content.insert(file.Content.end(), Magic.begin(), Magic.end());
    return file;
}

TEST(McapReader, RefusesASummaryWithMoreChunksThanTheLimit)
{
    ChunkIndex chunk;
    for (std::uint16_t channel = 0; channel < 1000; ++channel)
    {
        chunk.MessageIndexOffsets[channel] = channel;
    }
    Bytes chunks;
    for (int number = 0; number < 10; ++number)
    {
        Append(chunks, chunk);
    }
    MemoryFile file = WithSummary(chunks);
    EXPECT_EQ(ReadContents(file).Chunks.size(), 10U);
    const Contents contents = ReadContents(file, {.Indexes = 500'000});
    EXPECT_FALSE(contents.IsIndexed);
    EXPECT_TRUE(contents.Chunks.empty());
}

TEST(McapReader, RefusesASummaryWithMoreAttachmentsThanTheLimit)
{
    Bytes attachments;
    for (int number = 0; number < 10; ++number)
    {
        Append(attachments, AttachmentIndex{.Name = std::string(1000, 'x'), .MediaType = ""});
    }
    MemoryFile file = WithSummary(attachments);
    EXPECT_EQ(ReadContents(file).Attachments.size(), 10U);
    EXPECT_FALSE(ReadContents(file, {.Indexes = 9'000}).IsIndexed);
}

TEST(McapReader, SaysFromWhereOnAFileHasMoreChunksThanTheLimit)
{
    SmallRecording recording;
    const Contents whole = ScanContents(recording.File);
    ASSERT_GT(whole.Chunks.size(), 2U);
    const Contents contents =
        ScanContents(recording.File, {.Indexes = 2 * sizeof(ChunkIndex) + sizeof(AttachmentIndex) + 100});
    ASSERT_EQ(contents.Chunks.size(), 2U);
    ASSERT_EQ(contents.Problems.size(), 1U);
    EXPECT_EQ(contents.Problems[0], "there are too many chunks: messages from the one at byte " +
                                        std::to_string(whole.Chunks[2].Offset) +
                                        " on can only be read by `recover`");
}

// Bytes of a file are changed, cut and moved. In each case reading must end, and must return only bytes
// within the file.
TEST(McapReader, SurvivesDamagedBytes)
{
    SmallRecording plain(false);
    WithoutChecksums(plain.File);
    SmallRecording compressed(true);
    std::mt19937 random(1U);
    for (int round = 0; round < 3000; ++round)
    {
        MemoryFile file = round % 2 == 0 ? plain.File : compressed.File;
        Bytes &bytes = file.Content;
        for (unsigned change = 1 + random() % 4; change > 0; --change)
        {
            // Damage to the beginning, the summary and the heads of records does the most harm.
            const std::size_t near = random() % 3;
            const std::size_t at =
                near == 0   ? random() % std::min<std::size_t>(bytes.size(), 600)
                : near == 1 ? bytes.size() - 1 - random() % std::min<std::size_t>(bytes.size(), 1500)
                            : random() % bytes.size();
            switch (random() % 4)
            {
                case 0:
                    bytes[at] = static_cast<std::uint8_t>(random());
                    break;
                case 1:
                    bytes[at] = random() % 2 == 0 ? 0 : 0xFF;
                    break;
                case 2:
                    bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
                    break;
                default:
                    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), 1 + random() % 9,
                                 static_cast<std::uint8_t>(random()));
            }
        }
        const Contents contents = ReadContents(file);
        MessagesOf(file, contents);
        MemoryFile recovered;
        McapWriter writer(recovered, {});
        ASSERT_TRUE(Recover(file, writer).IsWritten);
        ASSERT_TRUE(ReadContents(recovered).IsIndexed);
    }
}

// The records of a file by themselves: each may be cut anywhere.
TEST(McapReader, SurvivesRecordsOfAnyLength)
{
    SmallRecording recording(false);
    RecordScanner scanner(recording.File);
    while (const auto record = scanner.Next())
    {
        for (std::size_t size = 0; size < std::min<std::size_t>(record->Content.size(), 300); ++size)
        {
            const Bytes content(record->Content.begin(),
                                record->Content.begin() + static_cast<std::ptrdiff_t>(size));
            Read<Header>(content);
            Read<Footer>(content);
            Read<Schema>(content);
            Read<Channel>(content);
            Read<Message>(content);
            Read<Chunk>(content);
            Read<MessageIndex>(content);
            Read<ChunkIndex>(content);
            Read<Attachment>(content);
            Read<AttachmentIndex>(content);
            Read<Statistics>(content);
            Read<Metadata>(content);
            Read<MetadataIndex>(content);
            Read<SummaryOffset>(content);
        }
    }
}

}  // namespace
