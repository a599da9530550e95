// A folder of recordings, and the posts that FolderPosts finds in it.
#pragma once

#include <gtest/gtest.h>
#include <rabit/mcap/McapWriter.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "backfill/FolderPosts.h"

namespace Rabit::Backfill
{

inline constexpr std::uint64_t Second = 1'000'000'000;
inline constexpr std::uint64_t Begin = 1'795'725'000 * Second;
inline constexpr std::int64_t SourceToLog = 5'000'000'123;
inline constexpr std::uint64_t Always = 1'000'000;

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

inline Stamp StampAfter(std::uint64_t at)
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
    std::vector<PostsCodec::Span> SpansOf(const std::string &message, std::uint64_t last)
    {
        const auto spans = posts->Spans(message, last);
        EXPECT_TRUE(spans) << "the folder can be read";
        return spans.value_or(std::vector<PostsCodec::Span>());
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

}  // namespace Rabit::Backfill
