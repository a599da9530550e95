#pragma once

#include <cstddef>
#include <cstdint>
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
    // posts in these ranges that were recorded at all can be read.
    virtual std::vector<PostsCodec::Span> Spans(const std::string &message, std::uint64_t last) = 0;

    struct Found
    {
        Stamp First = 0;          // Posts holds all of [First, range.End) that are not in `had`
        std::vector<Post> Posts;  // rising
        bool IsReadable = true;
    };
    // Returns the newest posts of that range, which lies in one of Spans, that are not in `had` (rising): as
    // many as have `most` bytes together, at least one. Posts with the stamp of an earlier one are left out.
    virtual Found Read(const std::string &message, std::uint64_t incarnation, Range range,
                       const std::vector<Stamp> &had, std::size_t most) = 0;
};

}  // namespace Rabit::Backfill
