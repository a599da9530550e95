#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backfill/PostStore.h"
#include "backfill/RecordingIndex.h"

namespace Rabit::Backfill
{

// The posts in the recordings of this node, those of former incarnations included. Not thread-safe.
class FolderPosts final : public PostStore
{
public:
    // Messages are in a file this long after they were recorded, unless the disk is slower. Then the newest
    // message that is in the file is as late.
    static constexpr std::uint64_t SettledAfter = 1'000'000'000;

    FolderPosts(const std::string &folder, const std::string &node);

    // The present incarnation, whose recording is still being written, and the log time now: files with later
    // times, of a clock that was wrong, do not count for the age of the others.
    void SetPresent(std::uint64_t incarnation, std::uint64_t now)
    {
        _incarnation = incarnation;
        _now = now;
    }

    std::optional<std::vector<PostsCodec::Span>> Spans(const std::string &message,
                                                       std::uint64_t last) override;
    Found Read(const std::string &message, std::uint64_t incarnation, Range range,
               const std::vector<Stamp> &had, std::size_t most) override;
    std::uint64_t Present() const override { return _incarnation; }

private:
    // The first posts of an incarnation are in one of so many parts: small and large messages have chunks of
    // their own, which are written one after the other.
    static constexpr std::size_t FirstParts = 2;

    // The pieces of one message in one file, and the clock of that file.
    struct Part
    {
        const RecordingIndex::File *File = nullptr;
        const RecordingIndex::Piece *Piece = nullptr;
        std::int64_t SourceToLog = 0;
        // The chunk that says which message the channel has is damaged: these may be posts of any.
        bool IsOfUnknownChannel = false;

        Stamp LastStamp() const;
    };
    std::map<std::uint64_t, std::vector<Part>> PartsOf(const std::string &message) const;
    // Empty: it cannot be read now.
    std::optional<Stamp> FirstStamp(const std::vector<Part> &parts);
    RecordingIndex::Access Visit(const Part &part,
                                 const std::function<void(const Mcap::Message &message)> &visit);

    const std::string _node;
    RecordingIndex _index;
    bool IsPast(const RecordingIndex::File &file) const;

    std::uint64_t _incarnation = 0;
    std::uint64_t _now = ~std::uint64_t{0};
    std::map<std::pair<std::string, std::uint64_t>, Stamp> _firsts;  // by file and chunk
};

}  // namespace Rabit::Backfill
