// The posts in recordings: of former incarnations, of a file that grows, and of files that are gone.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "PostsFolder.h"

namespace Rabit::Backfill
{
namespace
{

TEST_F(FolderPostsTest, WithoutRecordingsThereIsNothing)
{
    EXPECT_TRUE(SpansOf("Pose", Always).empty());
    EXPECT_TRUE(Times({0, ~Stamp{0}}).empty());
}

TEST_F(FolderPostsTest, AnEndedRecordingIsReadAsAWhole)
{
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->Post(2 * Second);
    file->End();
    const auto spans = SpansOf("Pose", Always);
    ASSERT_EQ(spans.size(), 1U);
    EXPECT_EQ(spans[0].Incarnation, 7U);
    EXPECT_EQ(spans[0].Stamps.First, StampAfter(1 * Second));
    EXPECT_GT(spans[0].Stamps.End, StampAfter(2 * Second));
    EXPECT_EQ(Times(spans[0].Stamps), (std::vector<std::int64_t>{1'000'000'000, 2'000'000'000}));
    EXPECT_EQ(found.First, spans[0].Stamps.First);
    EXPECT_EQ(found.Posts[0].Bytes, std::vector<std::uint8_t>(10, static_cast<std::uint8_t>(1000)));
    EXPECT_TRUE(SpansOf("Other", Always).empty());
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
    EXPECT_EQ(SpansOf("Pose", Always).at(0).Stamps.End, StampAfter(3 * Second));
    file->Post(6 * Second);
    file->Tick(9 * Second);
    file->Tick(10 * Second);
    file->Tick(21 * Second / 2);
    const Range stamps = SpansOf("Pose", Always).at(0).Stamps;
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
    const Range stamps = SpansOf("Pose", Always).at(0).Stamps;
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
    Range stamps = SpansOf("Pose", Always).at(0).Stamps;
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
    Range stamps = SpansOf("Pose", Always).at(0).Stamps;
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
    EXPECT_EQ(Times(SpansOf("Pose", Always).at(0).Stamps),
              (std::vector<std::int64_t>{1'000'000'000, 70'000'000'000}));
}

TEST_F(FolderPostsTest, APostFromBeforeTheRecordingIsInTheSpan)
{
    const auto file = NewFile(1);
    file->Post(1 * Second, 10, 100 * Second);
    file->Post(102 * Second);
    file->End();
    const Range stamps = SpansOf("Pose", Always).at(0).Stamps;
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
    const auto spans = SpansOf("Pose", Always);
    ASSERT_EQ(spans.size(), 2U);
    EXPECT_EQ(spans[0].Incarnation, 7U);
    EXPECT_EQ(spans[1].Incarnation, 8U);
    EXPECT_EQ(SpansOf("Pose", 50).size(), 1U) << "only the last 50 seconds";
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
    const auto spans = SpansOf("Pose", 60);
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
    const auto spans = SpansOf("Pose", 60);
    ASSERT_EQ(spans.size(), 1U);
    EXPECT_EQ(Times(spans[0].Stamps), (std::vector<std::int64_t>{100'000'000'000, 103'000'000'000}));
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
    EXPECT_LE(SpansOf("Pose", Always).at(0).Stamps.End, StampAfter(2 * Second))
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
    EXPECT_EQ(SpansOf("Pose", Always).at(0).Stamps.End, StampAfter(3 * Second));
}

TEST_F(FolderPostsTest, AFileThatWasNotWrittenToForADayIsNotRead)
{
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->End();
    const auto path = folder / "uav1_000001_20261123T024640Z.mcap";
    std::filesystem::last_write_time(path, std::filesystem::last_write_time(path) - std::chrono::hours(26));
    EXPECT_TRUE(SpansOf("Pose", Always).empty());
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
    EXPECT_EQ(SpansOf("Pose", Always).size(), 1U);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    EXPECT_TRUE(SpansOf("Pose", Always).empty());
}

TEST_F(FolderPostsTest, ASpanBeginsLaterOnceTheOldestFileIsRemoved)
{
    for (int number = 1; number <= 2; ++number)
    {
        const auto file = NewFile(number);
        file->Post(static_cast<std::uint64_t>(number) * 10 * Second);
        file->End();
    }
    EXPECT_EQ(SpansOf("Pose", Always).at(0).Stamps.First, StampAfter(10 * Second));
    std::filesystem::remove(folder / "uav1_000001_20261123T024640Z.mcap");
    EXPECT_EQ(SpansOf("Pose", Always).at(0).Stamps.First, StampAfter(20 * Second));
}

// Large messages have a chunk of their own, which is written behind that of the small ones.
TEST_F(FolderPostsTest, TheFirstPostMayBeALargeOne)
{
    const auto file = NewFile(1);
    file->Post(1 * Second, 20'000);
    file->Post(2 * Second);
    file->Flush();
    file->Post(100 * Second);
    file->End();
    const Range stamps = SpansOf("Pose", Always).at(0).Stamps;
    EXPECT_EQ(stamps.First, StampAfter(1 * Second));
    EXPECT_EQ(Times(stamps), (std::vector<std::int64_t>{1'000'000'000, 2'000'000'000, 100'000'000'000}));
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
        const auto spans = fresh.Spans("Pose", Always);
        for (const PostsCodec::Span &span : spans.value_or(std::vector<PostsCodec::Span>()))
        {
            fresh.Read("Pose", span.Incarnation, span.Stamps, {}, 1000);
        }
    }
}

}  // namespace
}  // namespace Rabit::Backfill
