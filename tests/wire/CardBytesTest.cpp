// Messages of cards, and a packed card.
#include <gtest/gtest.h>

#include <cstdint>
#include <string_view>
#include <vector>

#include "Hex.h"
#include "rtps/CardMessage.h"
#include "rtps/PackedCard.h"

namespace Rabit::Test
{
namespace
{

using namespace Rtps;

constexpr const char *MessageBytes =
    "52545053020252620102030405060708090a0b0cd201540002020101efcdab89\n"
    "67452301ef03000015cd5b0715161718191a1b1c1d1e1f200500000000000000\n"
    "0102030405060708090a0b0cffffffffffffffff15161718191a1b1c1d1e1f20\n"
    "00286beec0ffee0102030400";
constexpr const char *SummaryBytes =
    "52545053020252620102030405060708090a0b0cd20114000200000010325476\n"
    "98badcfe5802000007000000";
// Other versions of zstd may pack otherwise, so this one is read alone.
constexpr const char *PackedBytes = "28b52ffd2031a500007052545053206f662061206e6f6465010040162d";
constexpr std::string_view Card = "RTPS RTPS RTPS RTPS RTPS RTPS RTPS RTPS of a node";

constexpr GuidPrefix Sender = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
constexpr GuidPrefix Other = {21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32};
const std::vector<std::uint8_t> Part = {0xc0, 0xff, 0xee, 0x01, 0x02, 0x03, 0x04};

// A message with two requests and the last part of a card.
CardMessage FullMessage()
{
    return {.From = Sender,
            .Summary = {.Digest = 0x0123456789abcdef, .Size = 1007},
            .SentAt = 123'456'789,
            .Requests = {{.Of = Other, .Parts = 5}, {.Of = Sender, .Parts = ~std::uint64_t{0}}},
            .HasPart = true,
            .Part = 1,
            .Answers = {.From = Other, .SentAt = 4'000'000'000U},
            .Bytes = Part};
}

// A message that only says which card the sender has.
CardMessage Summary()
{
    return {.From = Sender, .Summary = {.Digest = 0xfedcba9876543210, .Size = 600}, .SentAt = 7};
}

TEST(CardBytes, OfAFullMessageAreAccepted)
{
    const std::vector<std::uint8_t> bytes = BytesOf(MessageBytes);
    const auto read = ReadCardMessage(bytes);
    ASSERT_TRUE(read.has_value());
    const CardMessage expected = FullMessage();
    EXPECT_EQ(read->From, expected.From);
    EXPECT_EQ(read->Summary, expected.Summary);
    EXPECT_EQ(read->SentAt, expected.SentAt);
    ASSERT_EQ(read->Requests.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i)
    {
        EXPECT_EQ(read->Requests[i].Of, expected.Requests[i].Of);
        EXPECT_EQ(read->Requests[i].Parts, expected.Requests[i].Parts);
    }
    EXPECT_TRUE(read->HasPart);
    EXPECT_EQ(read->Part, expected.Part);
    EXPECT_EQ(read->Answers.From, expected.Answers.From);
    EXPECT_EQ(read->Answers.SentAt, expected.Answers.SentAt);
    EXPECT_EQ(HexOf(read->Bytes), HexOf(Part));
}

TEST(CardBytes, OfAFullMessageAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(WriteCardMessage(FullMessage())), MessageBytes);
}

TEST(CardBytes, OfASummaryAreAccepted)
{
    const auto read = ReadCardMessage(BytesOf(SummaryBytes));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->From, Sender);
    EXPECT_EQ(read->Summary, Summary().Summary);
    EXPECT_EQ(read->SentAt, 7U);
    EXPECT_TRUE(read->Requests.empty());
    EXPECT_FALSE(read->HasPart);
}

TEST(CardBytes, OfASummaryAreTheRecordedOnes)
{
    EXPECT_EQ(HexOf(WriteCardMessage(Summary())), SummaryBytes);
}

TEST(CardBytes, OfAPackedCardAreUnpacked)
{
    const std::vector<std::uint8_t> packed = BytesOf(PackedBytes);
    const auto card = UnpackCard(packed);
    ASSERT_TRUE(card.has_value());
    EXPECT_EQ(std::string_view(reinterpret_cast<const char *>(card->data()), card->size()), Card);
    // Both sides compute the digest of a packed card.
    EXPECT_EQ(SummaryOf(packed), (CardSummary{.Digest = 13729475563813108361U, .Size = 29}));
}

}  // namespace
}  // namespace Rabit::Test
