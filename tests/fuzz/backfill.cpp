// Questions and answers of backfill: stamps, spans and posts.
#include <algorithm>

#include "Input.h"
#include "backfill/PostsCodec.h"

namespace
{

namespace Codec = Rabit::Backfill::PostsCodec;

bool AreSame(const std::vector<Rabit::Backfill::Post> &some, const std::vector<Rabit::Backfill::Post> &others)
{
    return std::equal(some.begin(), some.end(), others.begin(), others.end(),
                      [](const auto &one, const auto &other)
                      { return one.SourceTime == other.SourceTime && one.Bytes == other.Bytes; });
}

}  // namespace

int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    Fuzz::Input input(data, size);
    Rabit::Backfill::Stamp first = 0;
    for (int shift = 0; shift < 64; shift += 8)
    {
        first |= static_cast<Rabit::Backfill::Stamp>(input.Byte()) << shift;
    }
    const std::vector<std::uint8_t> bytes = input.Part();
    if (const auto stamps = Codec::DecodeStamps(bytes, first))
    {
        Fuzz::Require(Codec::DecodeStamps(Codec::EncodeStamps(*stamps, first), first) == stamps);
    }
    if (const auto spans = Codec::DecodeSpans(bytes))
    {
        Fuzz::Require(spans->size() <= Codec::MostSpans);
        Fuzz::Require(Codec::DecodeSpans(Codec::EncodeSpans(*spans)) == spans);
    }
    if (const auto posts = Codec::DecodePosts(bytes, first))
    {
        const auto again = Codec::DecodePosts(Codec::EncodePosts(*posts, first), first);
        Fuzz::Require(again && AreSame(*again, *posts));
    }
    return 0;
}
