// Posts in recordings that are damaged or cut off, or cannot be read now.
#include <array>
#include <filesystem>
#include <fstream>
#include <vector>

#include "../../NoDescriptors.h"
#include "PostsFolder.h"

namespace Rabit::Backfill
{
namespace
{

using UnreadablePostsTest = FolderPostsTest;

// Three chunks, of which the second or the third is damaged.
class DamagedPostsTest : public UnreadablePostsTest
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
        const auto spans = SpansOf("Pose", Always);
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
TEST_F(UnreadablePostsTest, OfManyChunksOneThatIsDamagedIsLeftOutAndAllOthersAreGiven)
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
    const Range all = SpansOf("Pose", Always).at(0).Stamps;
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
TEST_F(UnreadablePostsTest, IfTheDescriptionOfTheChannelsIsDamagedNothingIsTakenForWhole)
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
    EXPECT_TRUE(Times(SpansOf("Pose", Always).at(0).Stamps).empty());
    EXPECT_EQ(found.Is, PostStore::Found::Result::Damaged);
    file->End();  // with a summary, which describes the channels once more
    posts = std::make_unique<FolderPosts>(folder.string(), "uav1");
    EXPECT_EQ(Times(SpansOf("Pose", Always).at(0).Stamps),
              (std::vector<std::int64_t>{2'000'000'000, 3'000'000'000}));
}

// Without a free descriptor the folder cannot be looked at. A second later it can.
TEST_F(UnreadablePostsTest, AFolderThatCannotBeReadNowIsNotEmpty)
{
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->End();
    {
        const NoDescriptors none;
        EXPECT_FALSE(posts->Spans("Pose", Always));
    }
    EXPECT_EQ(SpansOf("Pose", Always).size(), 1U);
}

// The folder can be read, and the file, but not its chunk beside it.
TEST_F(UnreadablePostsTest, AFileThatCannotBeReadNowIsNotTakenForOneWithoutPosts)
{
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->End();
    {
        const NoDescriptors butOne(1);
        EXPECT_FALSE(posts->Spans("Pose", Always));
    }
    EXPECT_EQ(Times(SpansOf("Pose", Always).at(0).Stamps), (std::vector<std::int64_t>{1'000'000'000}));
}

// A folder with recordings that is not there may be one that is not mounted now.
TEST_F(UnreadablePostsTest, RecordingsWhoseFolderIsMissingAreNotTakenForRemoved)
{
    const auto file = NewFile(1);
    file->Post(1 * Second);
    file->End();
    EXPECT_EQ(SpansOf("Pose", Always).size(), 1U);
    const std::filesystem::path away = folder.string() + "_away";
    std::filesystem::rename(folder, away);
    EXPECT_FALSE(posts->Spans("Pose", Always));
    std::filesystem::rename(away, folder);
    EXPECT_EQ(SpansOf("Pose", Always).size(), 1U);
}

// A recording that was killed between a chunk and its indexes.
class CutOffPostsTest : public UnreadablePostsTest
{
protected:
    // Leaves the last chunk, in which the post of 2 s is, without its indexes.
    void Write(bool isDamaged)
    {
        const std::filesystem::path path = folder / "uav1_000001_20261123T024640Z.mcap";
        {
            const auto file = NewFile(1);
            file->Post(1 * Second);
            file->Flush();
            const std::uintmax_t chunk = std::filesystem::file_size(path);
            file->Post(2 * Second);
            file->Flush();
            std::array<char, 9> head{};
            std::ifstream stream(path, std::ios::binary);
            stream.seekg(static_cast<std::streamoff>(chunk));
            stream.read(head.data(), static_cast<std::streamsize>(head.size()));
            std::uintmax_t length = 0;
            for (std::size_t i = 8; i > 0; --i)
            {
                length = length << 8 | static_cast<unsigned char>(head[i]);
            }
            cutAt = chunk + head.size() + length;
            damagedAt = chunk + 60;
        }
        std::filesystem::resize_file(path, cutAt);
        if (isDamaged)
        {
            std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
            stream.seekp(static_cast<std::streamoff>(damagedAt));
            stream.write("spoilt", 6);
        }
        NewFile(2, 8)->End();
    }

    std::uintmax_t cutAt = 0;
    std::uintmax_t damagedAt = 0;
};

TEST_F(CutOffPostsTest, AChunkWithoutItsIndexesIsReadNevertheless)
{
    Write(false);
    const Range stamps = SpansOf("Pose", Always).at(0).Stamps;
    EXPECT_GT(stamps.End, StampAfter(2 * Second));
    EXPECT_EQ(Times(stamps), (std::vector<std::int64_t>{1'000'000'000, 2'000'000'000}));
}

TEST_F(CutOffPostsTest, ADamagedChunkWithoutItsIndexesIsSaidToBeDamaged)
{
    Write(true);
    const Range stamps = SpansOf("Pose", Always).at(0).Stamps;
    EXPECT_GT(stamps.End, StampAfter(2 * Second));
    EXPECT_TRUE(Times(stamps).empty());
    EXPECT_EQ(found.Is, PostStore::Found::Result::Damaged);
    EXPECT_EQ(Times({stamps.First, found.First}), (std::vector<std::int64_t>{1'000'000'000}));
}

}  // namespace
}  // namespace Rabit::Backfill
