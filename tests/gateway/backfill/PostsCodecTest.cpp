#include "backfill/PostsCodec.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace Rabit::Backfill::PostsCodec
{
namespace
{

constexpr std::int64_t Now = 1'795'725'000'123'456'789;

TEST(PostsCodecTest, StampsSpansAndPostsComeBackAsTheyWere)
{
    const Stamp first = StampOf(Now);
    const std::vector<Stamp> stamps = {first, first + 1, first + 200'000, first + 3'000'000'000};
    EXPECT_EQ(DecodeStamps(EncodeStamps(stamps, first), first), stamps);
    const std::vector<Span> spans = {{std::numeric_limits<std::uint64_t>::max(), {first, first + 7}},
                                     {1, {0, 0}}};
    EXPECT_EQ(DecodeSpans(EncodeSpans(spans)), spans);
    const std::vector<Post> posts = {{Now, {1, 2, 3}}, {Now + 1, {}}, {Now + 60'000'000'000, {255}}};
    EXPECT_EQ(DecodePosts(EncodePosts(posts, first), first), posts);
}

TEST(PostsCodecTest, AStampOfTenValuesASecondTakesThreeBytes)
{
    std::vector<Stamp> stamps;
    for (int i = 0; i < 100; ++i)
    {
        stamps.push_back(StampOf(Now + std::int64_t{i} * 100'000'000));
    }
    EXPECT_LE(EncodeStamps(stamps, stamps[0]).size(), 300U);
}

TEST(PostsCodecTest, TruncatedBytesAreRefused)
{
    const std::vector<Post> posts = {{Now, {1, 2, 3}}};
    const auto bytes = EncodePosts(posts, StampOf(Now));
    for (std::size_t size = 1; size < bytes.size(); ++size)
    {
        EXPECT_FALSE(DecodePosts(std::span(bytes).first(size), StampOf(Now))) << size;
    }
}

TEST(PostsCodecTest, AnyBytesAreEitherDecodedOrRefused)
{
    std::mt19937 random(1);
    for (int i = 0; i < 20'000; ++i)
    {
        std::vector<std::uint8_t> bytes(random() % 40);
        for (std::uint8_t &byte : bytes)
        {
            byte = static_cast<std::uint8_t>(random() % 3 == 0 ? 0xFF : random());
        }
        const Stamp first = random() % 2 == 0 ? std::numeric_limits<Stamp>::max() : random();
        const auto posts = DecodePosts(bytes, first);
        EXPECT_LE(posts ? posts->size() : 0, bytes.size());
        static_cast<void>(DecodeStamps(bytes, first));
        static_cast<void>(DecodeSpans(bytes));
    }
}

}  // namespace
}  // namespace Rabit::Backfill::PostsCodec
