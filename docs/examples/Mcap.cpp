// A recording is read, and an MCAP file of a program's own is written.
#include <gtest/gtest.h>
#include <rabit/mcap/ByteSink.h>
#include <rabit/mcap/ByteSource.h>
#include <rabit/mcap/ChunkReader.h>
#include <rabit/mcap/FileSink.h>
#include <rabit/mcap/FileSource.h>
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/McapRecords.h>
#include <rabit/mcap/McapRecovery.h>
#include <rabit/mcap/McapWriter.h>
#include <rabit/mcap/MessageCursor.h>
#include <rabit/mcap/RecordCodec.h>
#include <rabit/mcap/RecordScanner.h>
#include <rabit/mcap/RecordedChannel.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

namespace
{

// [memory]
// A file in memory, which a writer fills and a reader reads.
class FileInMemory : public Rabit::Mcap::ByteSink, public Rabit::Mcap::ByteSource
{
public:
    bool Write(Rabit::Mcap::ByteView bytes) override
    {
        _bytes.insert(_bytes.end(), bytes.begin(), bytes.end());
        return true;
    }
    std::uint64_t Size() override { return _bytes.size(); }
    bool Read(std::uint64_t offset, std::span<std::uint8_t> to) override
    {
        if (offset > _bytes.size() || to.size() > _bytes.size() - offset)
        {
            return false;
        }
        std::copy_n(_bytes.begin() + static_cast<std::ptrdiff_t>(offset), to.size(), to.begin());
        return true;
    }
    void LoseTheEnd(std::size_t bytes) { _bytes.resize(_bytes.size() - bytes); }

private:
    Rabit::Mcap::Bytes _bytes;
};
// [/memory]

// [write]
void WriteTwoMessages(Rabit::Mcap::ByteSink &sink)
{
    Rabit::Mcap::McapWriter writer(sink, {"station 1.0", "", true});
    const std::uint16_t schema = writer.AddSchema("Wind", "omgidl", "struct Wind { octet speed; };");
    const std::optional<std::uint16_t> channel = writer.AddChannel(schema, "station/Wind", "cdr");
    const Rabit::Mcap::Bytes calm{0, 1, 0, 0, 0};
    const Rabit::Mcap::Bytes gust{0, 1, 0, 0, 9};
    writer.Add({channel.value(), 0, 1000, 1000, calm});  // nanoseconds since 1970
    writer.Add({channel.value(), 0, 2000, 2000, gust});
    EXPECT_TRUE(writer.Finish());
}
// [/write]

// [read]
TEST(McapExample, TheMessagesSinceAMomentAreRead)
{
    FileInMemory file;
    WriteTwoMessages(file);
    const Rabit::Mcap::Contents contents = Rabit::Mcap::ReadContents(file);
    EXPECT_TRUE(contents.IsIndexed);

    Rabit::Mcap::MessageCursor::Selection since;
    since.From = 1500;
    Rabit::Mcap::MessageCursor cursor(file, contents, since);
    const std::optional<Rabit::Mcap::Message> message = cursor.Next();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->LogTime, 2000u);
    EXPECT_EQ(message->Data.back(), 9);
    const Rabit::Mcap::RecordedChannel channel =
        Rabit::Mcap::Describe(contents.Channels.at(message->ChannelId));
    EXPECT_EQ(channel.Node, "station");
    EXPECT_EQ(channel.Message, "Wind");
    EXPECT_FALSE(cursor.Next());
    EXPECT_TRUE(cursor.Problems().empty());
}
// [/read]

// [file]
TEST(McapExample, AFileThatIsNoRecordingIsAProblem)
{
    const std::string path = ::testing::TempDir() + "rabit-mcap-" + std::to_string(::getpid());
    std::ofstream(path) << "no recording";
    Rabit::Mcap::FileSource source(path);
    EXPECT_FALSE(Rabit::Mcap::IsRecording(source));
    EXPECT_FALSE(Rabit::Mcap::ReadContents(source).Problems.empty());
    std::filesystem::remove(path);
    EXPECT_THROW(Rabit::Mcap::FileSource{path}, std::runtime_error);
}
// [/file]

// [sink]
TEST(McapExample, ANewFileIsWrittenAndNeverOverwritesAnother)
{
    const std::string path = ::testing::TempDir() + "rabit-mcap-new-" + std::to_string(::getpid());
    {
        Rabit::Mcap::FileSink file(path);
        WriteTwoMessages(file);
        EXPECT_TRUE(file.Sync());
    }
    Rabit::Mcap::FileSource source(path);
    EXPECT_TRUE(Rabit::Mcap::IsRecording(source));
    EXPECT_THROW(Rabit::Mcap::FileSink{path}, std::runtime_error);
    std::filesystem::remove(path);
}
// [/sink]

// [recover]
TEST(McapExample, ATruncatedFileIsRecovered)
{
    FileInMemory truncated;
    WriteTwoMessages(truncated);
    truncated.LoseTheEnd(20);
    EXPECT_FALSE(Rabit::Mcap::ReadContents(truncated).IsIndexed);

    FileInMemory recovered;
    Rabit::Mcap::McapWriter writer(recovered, {"station 1.0", "", true});
    const Rabit::Mcap::Recovered result = Rabit::Mcap::Recover(truncated, writer);
    EXPECT_TRUE(result.IsWritten);
    EXPECT_EQ(result.Messages, 2u);
    EXPECT_TRUE(Rabit::Mcap::ReadContents(recovered).IsIndexed);
}
// [/recover]

// [records]
// Counts the messages record by record, as a program does that needs no index.
std::size_t CountMessages(Rabit::Mcap::ByteSource &source)
{
    std::size_t messages = 0;
    Rabit::Mcap::Bytes room;
    Rabit::Mcap::RecordScanner scanner(source);
    while (const auto record = scanner.Next())
    {
        if (record->Code != static_cast<std::uint8_t>(Rabit::Mcap::Opcode::Chunk))
        {
            continue;
        }
        const auto chunk = Rabit::Mcap::Read<Rabit::Mcap::Chunk>(record->Content);
        Rabit::Mcap::ByteView records;
        if (!chunk || !Rabit::Mcap::OpenChunk(*chunk, room, records).empty())
        {
            continue;  // a damaged chunk costs its own messages alone
        }
        Rabit::Mcap::RecordIterator iterator(records);
        while (const auto inner = iterator.Next())
        {
            if (inner->Code == static_cast<std::uint8_t>(Rabit::Mcap::Opcode::Message))
            {
                ++messages;
            }
        }
    }
    return messages;
}

TEST(McapExample, RecordsAreReadOneAfterTheOther)
{
    FileInMemory file;
    WriteTwoMessages(file);
    EXPECT_EQ(CountMessages(file), 2u);
}
// [/records]

}  // namespace
