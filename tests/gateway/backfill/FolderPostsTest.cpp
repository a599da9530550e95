// The posts in recordings: of former incarnations, of a file that grows, and of files that are gone.
#include "backfill/FolderPosts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "recording/mcap/McapWriter.h"

namespace Rabit::Backfill
{
namespace
{

constexpr std::uint64_t Second = 1'000'000'000;
constexpr std::uint64_t Begin = 1'795'725'000 * Second;
constexpr std::int64_t SourceToLog = 5'000'000'123;
constexpr std::uint64_t Always = 1'000'000;

// A recording that is being written.
class Recording final : public Mcap::ByteSink
{
public:
    Recording(const std::filesystem::path &path, const std::string &node, std::uint64_t incarnation)
        : _stream(path, std::ios::binary)
    {
        _writer = std::make_unique<Mcap::McapWriter>(*this, Mcap::McapWriter::Options{"test", "rabit", true});
        _writer->AddMetadata({"rabit.file", {{"node", node}}});
        _writer->AddMetadata({"rabit.clock",
                              {{"incarnation", std::to_string(incarnation)},
                               {"source_to_log_ns", std::to_string(SourceToLog)}}});
        const std::uint16_t schema = _writer->AddSchema("Pose", "omgidl", "struct Pose {};");
        _pose = *_writer->AddChannel(schema, node + "/Pose", "cdr",
                                     {{"rabit.kind", "posted"}, {"rabit.node", node}});
        _other = *_writer->AddChannel(schema, node + "/Other", "cdr",
                                      {{"rabit.kind", "posted"}, {"rabit.node", node}});
    }
    bool Write(Mcap::ByteView bytes) override
    {
        _stream.write(reinterpret_cast<const char *>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
        return _stream.good();
    }

    // Posts at that time after Begin; recorded a moment later.
    void Post(std::uint64_t at, std::size_t size = 10, std::uint64_t delay = 1000)
    {
        const Mcap::Bytes bytes(size, static_cast<std::uint8_t>(at / 1'000'000));
        _writer->Add({_pose, 0, Begin + at + delay, Begin + at, bytes});
    }
    // Something else is recorded, so that it is known how far the recording has come.
    void Tick(std::uint64_t at)
    {
        const Mcap::Bytes bytes(3);
        _writer->Add({_other, 0, Begin + at, Begin + at, bytes});
        Flush();
    }
    void Flush()
    {
        _writer->FinishChunks();
        _stream.flush();
    }
    void End()
    {
        _writer->Finish();
        _stream.flush();
    }

private:
    std::ofstream _stream;
    std::unique_ptr<Mcap::McapWriter> _writer;
    std::uint16_t _pose = 0;
    std::uint16_t _other = 0;
};

Stamp StampAfter(std::uint64_t at)
{
    return StampOf(static_cast<std::int64_t>(Begin + at) - SourceToLog);
}

class FolderPostsTest : public testing::Test
{
protected:
    FolderPostsTest()
    {
        std::string pattern = (std::filesystem::temp_directory_path() / "postsXXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        posts = std::make_unique<FolderPosts>(folder.string(), "uav1");
    }
    ~FolderPostsTest() override { std::filesystem::remove_all(folder); }

    std::unique_ptr<Recording> NewFile(int number, std::uint64_t incarnation = 7,
                                       const std::string &node = "uav1")
    {
        return std::make_unique<Recording>(
            folder / (node + "_00000" + std::to_string(number) + "_20261123T024640Z.mcap"), node,
            incarnation);
    }
    std::vector<std::int64_t> Times(Range range, const std::vector<Stamp> &had = {},
                                    std::size_t most = 1'000'000)
    {
        std::vector<std::int64_t> times;
        found = posts->Read("Pose", 7, range, had, most);
        for (const Post &post : found.Posts)
        {
            times.push_back(post.SourceTime + SourceToLog - static_cast<std::int64_t>(Begin));
        }
        return times;
    }

    std::filesystem::path folder;
    std::unique_ptr<FolderPosts> posts;
    PostStore::Found found;
};

TEST_F(FolderPostsTest, WithoutRecordingsThereIsNothing)
{
    EXPECT_TRUE(posts->Spans("Pose", Always).empty());
    EXPECT_TRUE(Times({0, ~Stamp{0}}).empty());
}

TEST_F(FolderPostsTest, AnEndedRecordingIsReadAsAWhole)
{
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->Post(2 * Second);
    file->End();
    const auto spans = posts->Spans("Pose", Always);
    ASSERT_EQ(spans.size(), 1U);
    EXPECT_EQ(spans[0].Incarnation, 7U);
    EXPECT_EQ(spans[0].Stamps.First, StampAfter(1 * Second));
    EXPECT_GT(spans[0].Stamps.End, StampAfter(2 * Second));
    EXPECT_EQ(Times(spans[0].Stamps), (std::vector<std::int64_t>{1'000'000'000, 2'000'000'000}));
    EXPECT_EQ(found.First, spans[0].Stamps.First);
    EXPECT_EQ(found.Posts[0].Bytes, std::vector<std::uint8_t>(10, static_cast<std::uint8_t>(1000)));
    EXPECT_TRUE(posts->Spans("Other", Always).empty());
}

TEST_F(FolderPostsTest, ThePresentRecordingIsWholeUpToASecondBeforeItsEnd)
{
    posts->SetPresent(7, Begin + 1000 * Second);
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->Tick(4 * Second);
    file->Tick(5 * Second);
    file->Tick(11 * Second /
               2);  // the last chunk is left for later, and the one before it may lack large messages
    EXPECT_EQ(posts->Spans("Pose", Always).at(0).Stamps.End, StampAfter(3 * Second));
    file->Post(6 * Second);
    file->Tick(9 * Second);
    file->Tick(10 * Second);
    file->Tick(21 * Second / 2);
    const Range stamps = posts->Spans("Pose", Always).at(0).Stamps;
    EXPECT_EQ(stamps.End, StampAfter(8 * Second));
    EXPECT_EQ(Times(stamps), (std::vector<std::int64_t>{1'000'000'000, 6'000'000'000}));
}

TEST_F(FolderPostsTest, PostsThatTheOtherNodeHasAreLeftOut)
{
    const auto file = NewFile(1);
    for (std::uint64_t at = 1; at <= 4; ++at)
    {
        file->Post(at * Second);
    }
    file->End();
    const Range stamps = posts->Spans("Pose", Always).at(0).Stamps;
    EXPECT_EQ(Times(stamps, {StampAfter(1 * Second), StampAfter(3 * Second)}),
              (std::vector<std::int64_t>{2'000'000'000, 4'000'000'000}));
}

TEST_F(FolderPostsTest, TheNewestComeFirstAsManyAsFit)
{
    const auto file = NewFile(1);
    for (std::uint64_t at = 1; at <= 9; ++at)
    {
        file->Post(at * Second, 100);
        file->Flush();
    }
    file->End();
    Range stamps = posts->Spans("Pose", Always).at(0).Stamps;
    EXPECT_EQ(Times(stamps, {}, 250), (std::vector<std::int64_t>{8'000'000'000, 9'000'000'000}));
    EXPECT_EQ(found.First, StampAfter(8 * Second));
    stamps.End = found.First;
    EXPECT_EQ(Times(stamps, {}, 50), (std::vector<std::int64_t>{7'000'000'000})) << "one at least";
    stamps.End = found.First;
    EXPECT_EQ(Times(stamps, {}, 700).size(), 6U);
    EXPECT_EQ(found.First, stamps.First) << "all are read";
}

TEST_F(FolderPostsTest, LargeAndSmallPostsOfOneTimeAreReadTogether)
{
    const auto file = NewFile(1);
    for (std::uint64_t at = 1; at <= 20; ++at)
    {
        file->Post(at * Second / 100, at % 2 == 0 ? 20'000 : 100);  // in two chunks
    }
    file->End();
    Range stamps = posts->Spans("Pose", Always).at(0).Stamps;
    std::size_t read = 0;
    while (!stamps.IsEmpty())
    {
        const auto times = Times(stamps, {}, 50'000);
        EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
        read += times.size();
        stamps.End = found.First;
    }
    EXPECT_EQ(read, 20U);
}

TEST_F(FolderPostsTest, AStateThatIsRepeatedInTheNextFileIsOnePost)
{
    const auto first = NewFile(1);
    first->Post(1 * Second);
    first->End();
    const auto second = NewFile(2);
    second->Post(1 * Second, 10, 60 * Second);  // repeated at its beginning
    second->Post(70 * Second);
    second->End();
    EXPECT_EQ(Times(posts->Spans("Pose", Always).at(0).Stamps),
              (std::vector<std::int64_t>{1'000'000'000, 70'000'000'000}));
}

TEST_F(FolderPostsTest, APostFromBeforeTheRecordingIsInTheSpan)
{
    const auto file = NewFile(1);
    file->Post(1 * Second, 10, 100 * Second);
    file->Post(102 * Second);
    file->End();
    const Range stamps = posts->Spans("Pose", Always).at(0).Stamps;
    EXPECT_EQ(stamps.First, StampAfter(1 * Second));
    EXPECT_EQ(Times(stamps).size(), 2U);
}

TEST_F(FolderPostsTest, EachIncarnationHasItsSpanAndOldOnesAreLeftOut)
{
    NewFile(1, 6)->Post(1 * Second);  // killed: nothing was flushed
    const auto old = NewFile(2, 7);
    old->Post(2 * Second);
    old->Flush();  // killed later
    const auto present = NewFile(3, 8);
    present->Post(100 * Second);
    present->End();
    const auto spans = posts->Spans("Pose", Always);
    ASSERT_EQ(spans.size(), 2U);
    EXPECT_EQ(spans[0].Incarnation, 7U);
    EXPECT_EQ(spans[1].Incarnation, 8U);
    EXPECT_EQ(posts->Spans("Pose", 50).size(), 1U) << "only the last 50 seconds";
}

// Its clock was wrong, or is now. Else nothing of the present would be new enough.
TEST_F(FolderPostsTest, ARecordingFromTheFutureDoesNotHideThePresent)
{
    const auto future = NewFile(1, 6);
    future->Post(1'000'000 * Second);
    future->End();
    const auto present = NewFile(2);
    present->Post(1 * Second);
    present->Tick(4 * Second);
    present->Tick(5 * Second);
    present->Tick(11 * Second / 2);
    posts->SetPresent(7, Begin + 6 * Second);
    const auto spans = posts->Spans("Pose", 60);
    ASSERT_EQ(spans.size(), 2U);
    EXPECT_EQ(spans[1].Incarnation, 7U);
    EXPECT_EQ(spans[1].Stamps.First, StampAfter(1 * Second));
    EXPECT_EQ(spans[1].Stamps.End, StampAfter(3 * Second));
}

TEST_F(FolderPostsTest, PostsOfAClockThatWasAheadAreGiven)
{
    const auto ahead = NewFile(1);
    ahead->Post(100 * Second);
    ahead->Post(103 * Second);
    ahead->End();
    posts->SetPresent(8, Begin + 50 * Second);
    const auto spans = posts->Spans("Pose", 60);
    ASSERT_EQ(spans.size(), 1U);
    EXPECT_EQ(Times(spans[0].Stamps), (std::vector<std::int64_t>{100'000'000'000, 103'000'000'000}));
}

// Three chunks, of which the second or the third is damaged.
class DamagedPostsTest : public FolderPostsTest
{
protected:
    void Write(std::size_t damaged)
    {
        const auto file = NewFile(1);
        std::vector<std::uintmax_t> ends;
        for (std::uint64_t chunk = 0; chunk < 3; ++chunk)
        {
            file->Post((10 * chunk + 1) * Second);
            file->Post((10 * chunk + 2) * Second);
            file->Flush();
            ends.push_back(std::filesystem::file_size(Path()));
        }
        file->End();
        // A chunk's records are behind its head, and its indexes, which stay whole, behind the chunk.
        const auto begin = ends[damaged - 1] + 60;
        std::fstream stream(Path(), std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(static_cast<std::streamoff>(begin));
        stream.write("spoilt", 6);
    }
    std::filesystem::path Path() const { return folder / "uav1_000001_20261123T024640Z.mcap"; }
    Range Span()
    {
        const auto spans = posts->Spans("Pose", Always);
        return spans.empty() ? Range() : spans[0].Stamps;
    }
};

TEST_F(DamagedPostsTest, AtTheEndAreSaidToBeDamagedAndTheOlderOnesAreGiven)
{
    Write(2);
    const Range span = Span();
    EXPECT_TRUE(Times(span).empty());
    EXPECT_EQ(found.Is, PostStore::Found::Result::Damaged);
    EXPECT_GT(found.First, StampAfter(12 * Second));
    EXPECT_LE(found.First, StampAfter(21 * Second));
    EXPECT_EQ(Times({span.First, found.First}),
              (std::vector<std::int64_t>{1'000'000'000, 2'000'000'000, 11'000'000'000, 12'000'000'000}));
    EXPECT_EQ(found.Is, PostStore::Found::Result::Readable);
}

TEST_F(DamagedPostsTest, InTheMiddleComeBehindTheNewerOnes)
{
    Write(1);
    const Range span = Span();
    EXPECT_EQ(Times(span), (std::vector<std::int64_t>{21'000'000'000, 22'000'000'000}));
    EXPECT_EQ(found.Is, PostStore::Found::Result::Readable);
    EXPECT_TRUE(Times({span.First, found.First}).empty());
    EXPECT_EQ(found.Is, PostStore::Found::Result::Damaged);
    EXPECT_EQ(Times({span.First, found.First}), (std::vector<std::int64_t>{1'000'000'000, 2'000'000'000}));
}

// Chunks lie close to each other, as a recorder writes them.
TEST_F(FolderPostsTest, OfManyChunksOneThatIsDamagedIsLeftOutAndAllOthersAreGiven)
{
    const std::filesystem::path path = folder / "uav1_000001_20261123T024640Z.mcap";
    const auto file = NewFile(1);
    file->Flush();
    std::uintmax_t damagedAt = 0;
    for (std::uint64_t chunk = 0; chunk < 10; ++chunk)
    {
        damagedAt = chunk == 4 ? std::filesystem::file_size(path) + 60 : damagedAt;
        file->Post(chunk * 300'000'000 + 1000);
        file->Post(chunk * 300'000'000 + 100'000'000);
        file->Flush();
    }
    file->End();
    {
        std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(static_cast<std::streamoff>(damagedAt));
        stream.write("spoilt", 6);
    }
    const Range all = posts->Spans("Pose", Always).at(0).Stamps;
    std::size_t given = 0;
    std::size_t questions = 0;
    for (Range left = all; !left.IsEmpty() && questions < 20; ++questions)
    {
        given += Times(left).size();
        left.End = found.First;
    }
    EXPECT_EQ(given, 18U);
    EXPECT_LE(questions, 4U);
}

// The chunk that tells which message each channel has is the first one.
TEST_F(FolderPostsTest, IfTheDescriptionOfTheChannelsIsDamagedNothingIsTakenForWhole)
{
    const std::filesystem::path path = folder / "uav1_000001_20261123T024640Z.mcap";
    const auto file = NewFile(1);
    file->Flush();
    const std::uintmax_t damagedAt = std::filesystem::file_size(path) + 60;
    for (std::uint64_t chunk = 0; chunk < 3; ++chunk)
    {
        file->Post((chunk + 1) * Second);
        file->Flush();
    }
    {
        std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(static_cast<std::streamoff>(damagedAt));
        stream.write("spoilt", 6);
    }
    NewFile(2, 8)->End();
    EXPECT_TRUE(Times(posts->Spans("Pose", Always).at(0).Stamps).empty());
    EXPECT_EQ(found.Is, PostStore::Found::Result::Damaged);
    file->End();  // with a summary, which describes the channels once more
    posts = std::make_unique<FolderPosts>(folder.string(), "uav1");
    EXPECT_EQ(Times(posts->Spans("Pose", Always).at(0).Stamps),
              (std::vector<std::int64_t>{2'000'000'000, 3'000'000'000}));
}

// While the disk stalls between a chunk of large messages and one of small ones that came before them.
TEST_F(FolderPostsTest, APostThatWaitsBehindALargeMessageIsNotTakenForMissing)
{
    posts->SetPresent(7, Begin + 1000 * Second);
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->Tick(2 * Second);
    file->Tick(3 * Second);
    file->Tick(9 * Second);   // what has just been written, and
    file->Tick(10 * Second);  // what is being written
    EXPECT_LE(posts->Spans("Pose", Always).at(0).Stamps.End, StampAfter(2 * Second))
        << "a post of the time from 3 s on may be in the next chunk";
}

// uav1_cam sorts behind uav1_000001: the file of uav1 that is being written is its newest nevertheless.
TEST_F(FolderPostsTest, TheFilesOfANodeWithALongerNameAreNotItsOwn)
{
    posts->SetPresent(7, Begin + 1000 * Second);
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->Tick(4 * Second);
    file->Tick(5 * Second);
    file->Tick(11 * Second / 2);
    NewFile(1, 7, "uav1_cam")->End();
    EXPECT_EQ(posts->Spans("Pose", Always).at(0).Stamps.End, StampAfter(3 * Second));
}

TEST_F(FolderPostsTest, AFileThatWasNotWrittenToForADayIsNotRead)
{
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->End();
    const auto path = folder / "uav1_000001_20261123T024640Z.mcap";
    std::filesystem::last_write_time(path, std::filesystem::last_write_time(path) - std::chrono::hours(26));
    EXPECT_TRUE(posts->Spans("Pose", Always).empty());
}

TEST_F(FolderPostsTest, FilesOfOtherNodesAndOnesThatAreGoneDoNotCount)
{
    NewFile(1, 7, "uav1_x")->End();
    const auto other = NewFile(2, 7, "uav2");
    other->Post(1 * Second);
    other->End();
    const auto own = NewFile(3);
    own->Post(1 * Second);
    own->End();
    EXPECT_EQ(posts->Spans("Pose", Always).size(), 1U);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    EXPECT_TRUE(posts->Spans("Pose", Always).empty());
}

TEST_F(FolderPostsTest, AFileOfAnyBytesIsRead)
{
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->End();
    const auto path = std::filesystem::directory_iterator(folder)->path();
    std::vector<char> bytes(std::filesystem::file_size(path));
    std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    for (std::size_t i = 8; i < bytes.size(); i += 3)
    {
        std::vector<char> spoiled = bytes;
        spoiled[i] = static_cast<char>(spoiled[i] ^ 0xFF);
        std::ofstream(path, std::ios::binary)
            .write(spoiled.data(), static_cast<std::streamsize>(bytes.size()));
        FolderPosts fresh(folder.string(), "uav1");
        for (const PostsCodec::Span &span : fresh.Spans("Pose", Always))
        {
            fresh.Read("Pose", span.Incarnation, span.Stamps, {}, 1000);
        }
    }
}

}  // namespace
}  // namespace Rabit::Backfill
