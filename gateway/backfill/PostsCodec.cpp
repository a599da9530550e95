#include "backfill/PostsCodec.h"

namespace Rabit::Backfill::PostsCodec
{
namespace
{

void AppendNumber(std::vector<std::uint8_t> &to, std::uint64_t number)
{
    for (; number >= 0x80; number >>= 7)
    {
        to.push_back(static_cast<std::uint8_t>(number | 0x80));
    }
    to.push_back(static_cast<std::uint8_t>(number));
}

// Reads the front of `from`, and takes it away.
std::optional<std::uint64_t> TakeNumber(std::span<const std::uint8_t> &from)
{
    std::uint64_t number = 0;
    for (unsigned shift = 0; shift < 64 && !from.empty(); shift += 7)
    {
        const std::uint8_t byte = from.front();
        from = from.subspan(1);
        number |= static_cast<std::uint64_t>(byte & 0x7F) << shift;
        if ((byte & 0x80) == 0)
        {
            return number;
        }
    }
    return std::nullopt;
}

// The largest time that may come: the year 2200. So sums cannot overflow.
constexpr Stamp LatestStamp = StampOf(7'258'118'400'000'000'000);

}  // namespace

std::vector<std::uint8_t> EncodeStamps(const std::vector<Stamp> &stamps, Stamp first)
{
    std::vector<std::uint8_t> bytes;
    for (const Stamp stamp : stamps)
    {
        AppendNumber(bytes, stamp - first);
        first = stamp;
    }
    return bytes;
}

std::vector<std::uint8_t> EncodeSpans(const std::vector<Span> &spans)
{
    std::vector<std::uint8_t> bytes;
    for (const Span &span : spans)
    {
        AppendNumber(bytes, span.Incarnation);
        AppendNumber(bytes, span.Stamps.First);
        AppendNumber(bytes, span.Stamps.End - span.Stamps.First);
    }
    return bytes;
}

std::vector<std::uint8_t> EncodePosts(const std::vector<Post> &posts, Stamp first)
{
    std::vector<std::uint8_t> bytes;
    std::int64_t before = TimeOf(first);
    for (const Post &post : posts)
    {
        AppendNumber(bytes, static_cast<std::uint64_t>(post.SourceTime - before));
        AppendNumber(bytes, post.Bytes.size());
        bytes.insert(bytes.end(), post.Bytes.begin(), post.Bytes.end());
        before = post.SourceTime;
    }
    return bytes;
}

std::optional<std::vector<Stamp>> DecodeStamps(std::span<const std::uint8_t> bytes, Stamp first)
{
    std::vector<Stamp> stamps;
    while (!bytes.empty())
    {
        const auto distance = TakeNumber(bytes);
        if (!distance || *distance > LatestStamp || first > LatestStamp)
        {
            return std::nullopt;
        }
        first += *distance;
        stamps.push_back(first);
    }
    return stamps;
}

std::optional<std::vector<Span>> DecodeSpans(std::span<const std::uint8_t> bytes)
{
    std::vector<Span> spans;
    while (!bytes.empty())
    {
        const auto incarnation = TakeNumber(bytes);
        const auto first = TakeNumber(bytes);
        const auto size = TakeNumber(bytes);
        if (!incarnation || !first || !size || *first > LatestStamp || *size > LatestStamp - *first ||
            spans.size() >= MostSpans)
        {
            return std::nullopt;
        }
        spans.push_back({*incarnation, {*first, *first + *size}});
    }
    return spans;
}

std::optional<std::vector<Post>> DecodePosts(std::span<const std::uint8_t> bytes, Stamp first)
{
    std::vector<Post> posts;
    if (first > LatestStamp)
    {
        return std::nullopt;
    }
    auto before = static_cast<std::uint64_t>(TimeOf(first));
    constexpr auto latest = static_cast<std::uint64_t>(TimeOf(LatestStamp));
    while (!bytes.empty())
    {
        const auto distance = TakeNumber(bytes);
        const auto size = TakeNumber(bytes);
        if (!distance || !size || *distance > latest - before || *size > bytes.size())
        {
            return std::nullopt;
        }
        before += *distance;
        const auto content = bytes.first(static_cast<std::size_t>(*size));
        bytes = bytes.subspan(content.size());
        posts.push_back({static_cast<std::int64_t>(before), {content.begin(), content.end()}});
    }
    return posts;
}

}  // namespace Rabit::Backfill::PostsCodec
