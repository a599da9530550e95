// Card messages and packed cards: equal after writing and reading; damaged bytes are refused.
#include "rtps/CardMessage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "guard/RtpsBytes.h"
#include "rtps/PackedCard.h"

namespace
{

using namespace Rabit::Rtps;
using RtpsBytes::Bytes;

const Bytes Part(CardPartSize, 0x5a);

CardMessage Full()
{
    return {.From = RtpsBytes::Sender,
            .Summary = {.Digest = 0x0123456789abcdef, .Size = 1500},
            .Requests = {{.Of = RtpsBytes::Other, .Parts = 5}},
            .HasPart = true,
            .Part = 0,
            .Answers = {.From = RtpsBytes::Other, .SentAt = 4'000'000'000u},
            .Bytes = Part};
}

TEST(CardMessage, IsTheSameAfterWritingAndReading)
{
    const Bytes datagram = WriteCardMessage(Full());
    ASSERT_TRUE(IsCardMessage(datagram));
    const auto read = ReadCardMessage(datagram);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->From, RtpsBytes::Sender);
    EXPECT_EQ(read->Summary, Full().Summary);
    ASSERT_EQ(read->Requests.size(), 1u);
    EXPECT_EQ(read->Requests[0].Of, RtpsBytes::Other);
    EXPECT_EQ(read->Requests[0].Parts, 5u);
    EXPECT_TRUE(read->HasPart);
    EXPECT_EQ(read->Answers.From, RtpsBytes::Other);
    EXPECT_EQ(read->Answers.SentAt, 4'000'000'000u);
    EXPECT_TRUE(std::equal(read->Bytes.begin(), read->Bytes.end(), Part.begin(), Part.end()));
}

// The sockets of Fast DDS take one certain byte for the beginning of statistics, and write into the bytes
// after it.
TEST(CardMessage, NeverEndsLikeStatistics)
{
    for (std::size_t size = 1; size <= 300; ++size)
    {
        const Bytes part(size, 0x80);
        const CardSummary summary{.Digest = 1, .Size = static_cast<std::uint32_t>(size)};
        const Bytes datagram = WriteCardMessage(
            {.From = RtpsBytes::Sender, .Summary = summary, .HasPart = true, .Part = 0, .Bytes = part});
        EXPECT_FALSE(EndsLikeStatistics(datagram)) << size;
        const auto read = ReadCardMessage(datagram);
        ASSERT_TRUE(read.has_value()) << size;
        EXPECT_EQ(read->Bytes.size(), size);
    }
}

TEST(CardMessage, OfRtpsIsNone)
{
    EXPECT_FALSE(IsCardMessage(RtpsBytes::ParticipantMessage()));
    EXPECT_FALSE(IsCardMessage({}));
}

TEST(CardMessage, CutShortIsNotRead)
{
    const Bytes datagram = WriteCardMessage(Full());
    for (std::size_t size = 0; size < datagram.size(); ++size)
    {
        EXPECT_FALSE(ReadCardMessage(std::span(datagram).first(size)).has_value()) << size;
    }
}

TEST(CardMessage, WithAPartThatTheCardDoesNotHaveIsNotRead)
{
    CardMessage message = Full();
    Bytes datagram = WriteCardMessage(message);
    datagram[20 + 4 + 2] = 2;  // the parts are 0 and 1
    EXPECT_FALSE(ReadCardMessage(datagram).has_value());
}

TEST(CardMessage, DamagedAtRandomIsReadWithinItsBounds)
{
    std::mt19937 random(1);
    for (int i = 0; i < 100'000; ++i)
    {
        Bytes datagram = WriteCardMessage(Full());
        for (int k = 0; k < 3; ++k)
        {
            datagram[20 + random() % (i % 2 == 0 ? 40 : datagram.size() - 20)] =
                static_cast<std::uint8_t>(random());
        }
        if (const auto read = ReadCardMessage(datagram))
        {
            EXPECT_LE(read->Requests.size(), MostCardRequests);
            EXPECT_LE(read->Summary.Size, LargestCard);
            EXPECT_LE(read->Bytes.size(), CardPartSize);
        }
    }
}

TEST(PackedCard, IsTheSameAfterPackingAndUnpacking)
{
    Bytes card(5000);
    std::mt19937 random(1);
    std::generate(card.begin(), card.end(), [&] { return static_cast<std::uint8_t>(random() % 4); });
    const Bytes packed = PackCard(card);
    EXPECT_LT(packed.size(), card.size() / 2);
    EXPECT_EQ(UnpackCard(packed), card);
}

TEST(PackedCard, DenserThanAnyHonestOneIsRefused)
{
    EXPECT_TRUE(PackCard(Bytes(LargestUnpackedCard + 1)).empty());
    const Bytes packed = PackCard(Bytes(LargestUnpackedCard));
    ASSERT_LT(packed.size(), 300u);
    EXPECT_FALSE(UnpackCard(packed).has_value());
}

// Names, keys and numbers differ, all else is the same.
TEST(PackedCard, OfAThousandEndpointsIsFarFromThatDensity)
{
    using namespace RtpsBytes;
    constexpr GuidPrefix name{1, 15, 7};
    Bytes card = Header(name);
    for (std::uint32_t endpoint = 1; endpoint <= 1000; ++endpoint)
    {
        card =
            Join({card, RtpsBytes::Submessage(
                            Data, DataBody(endpoint, WriterData(endpoint << 8 | 3, name), 0x000003c2), 5)});
    }
    const Bytes packed = PackCard(card);
    std::printf("%zu bytes pack to %zu\n", card.size(), packed.size());
    EXPECT_LT(card.size(), LargestDensity / 2 * packed.size());
    EXPECT_EQ(UnpackCard(packed), card);
}

TEST(PackedCard, ThatStatesALargerSizeIsRefused)
{
    Bytes packed = PackCard(Bytes(1000));
    ASSERT_TRUE(UnpackCard(packed).has_value());
    // The packed card now states a larger size.
    packed[5 + 2] = 0x7f;
    EXPECT_FALSE(UnpackCard(packed).has_value());
}

TEST(PackedCard, DamagedAtRandomNeitherCrashesNorGrows)
{
    std::mt19937 random(1);
    const Bytes packed =
        PackCard(RtpsBytes::Join({RtpsBytes::ParticipantMessage(), RtpsBytes::WriterMessage()}));
    for (int i = 0; i < 100'000; ++i)
    {
        Bytes damaged = packed;
        damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
        damaged.resize(1 + random() % damaged.size());
        const auto card = UnpackCard(damaged);
        EXPECT_LE(card ? card->size() : 0, LargestUnpackedCard);
    }
}

}  // namespace
