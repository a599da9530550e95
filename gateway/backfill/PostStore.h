#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "backfill/PostsCodec.h"
#include "backfill/Series.h"

namespace Rabit::Backfill
{

// The posts that this node has recorded.
class PostStore
{
public:
    virtual ~PostStore() = default;

    // The incarnations of which there are posts of this message that are at most `last` seconds old. All
    // posts in these ranges that were recorded at all can be read, but for those of a file that is damaged.
    // Posts that are older than a range, or of an incarnation without one, are there no more. Empty: it
    // cannot be told now, since a file or the folder cannot be read.
    virtual std::optional<std::vector<PostsCodec::Span>> Spans(const std::string &message,
                                                               std::uint64_t last) = 0;

    // Bytes that a post takes in an answer beside its own, at most.
    static constexpr std::size_t PostOverhead = 16;

    struct Found
    {
        Stamp First = 0;          // Posts holds all of [First, range.End) that are not in `had`
        std::vector<Post> Posts;  // rising
        enum class Result
        {
            Readable,
            Damaged,  // none of [First, range.End) can ever be read
            NotNow    // a file cannot be opened or read now
        };
        Result Is = Result::Readable;
    };
    // Returns the newest posts of that range, which lies in one of Spans, that are not in `had` (rising): as
    // many as have `most` bytes together, with PostOverhead for each, at least one. Posts with the stamp of
    // an earlier one are left out.
    virtual Found Read(const std::string &message, std::uint64_t incarnation, Range range,
                       const std::vector<Stamp> &had, std::size_t most) = 0;
    // The present incarnation of this node, whose recording goes on.
    virtual std::uint64_t Present() const = 0;
};

}  // namespace Rabit::Backfill
