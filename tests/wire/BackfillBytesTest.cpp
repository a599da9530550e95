// Questions and answers of backfill, with the stamps, spans and posts in them.
#include <gtest/gtest.h>
#include <rabit/idl/MessageType.h>

#include <cstdint>
#include <vector>

#include "Hex.h"
#include "backfill.idl.h"
#include "backfill/PostsCodec.h"

namespace Rabit::Backfill
{
namespace
{

using Test::BytesOf;
using Test::HexOf;

constexpr Stamp First = 1'000'000'000'000;

constexpr const char *StampsBytes = "00ac02ac9909";
constexpr const char *SpansBytes = "808080805080a094a58d1de807808080806088c794a58d1d01";
constexpr const char *PostsBytes = "0703c0ffeef9887a00";
constexpr const char *QuestionBytes =
    "000100000100000000000000887766554433221105000000506f736500000000\n"
    "0000000000000000050000000010a5d4e8000000401da8d4e800000006000000\n"
    "00ac02ac9909000000000000000100000000000000200000";
constexpr const char *AnswerBytes =
    "00010001020000000300000088776655443322110c000000666c696768742e6d\n"
    "6361700001000000000000000200000000000000030000000000000004000000\n"
    "00000000050000000000000003000000c0ffee00";

std::vector<Stamp> Stamps()
{
    return {First, First + 300, First + 151'000};
}

std::vector<PostsCodec::Span> Spans()
{
    return {{.Incarnation = 5ULL << 32, .Stamps = {First, First + 1000}},
            {.Incarnation = 6ULL << 32, .Stamps = {First + 5000, First + 5001}}};
}

std::vector<Post> Posts()
{
    return {{TimeOf(First) + 7, {0xc0, 0xff, 0xee}}, {TimeOf(First) + 2'000'000, {}}};
}

Question FullQuestion()
{
    Question question;
    question.kind = Kind::POSTS;
    question.number = 0x1122334455667788;
    question.name = "Pose";
    question.incarnation = 5ULL << 32;
    question.from = First;
    question.to = First + 200'000;
    question.had = PostsCodec::EncodeStamps(Stamps(), First);
    question.offset = 0x100;
    question.most = 0x2000;
    return question;
}

Answer FullAnswer()
{
    Answer answer;
    answer.kind = Kind::FACTS;
    answer.result = Result::FAILED;
    answer.number = 0x1122334455667788;
    answer.name = "flight.mcap";
    answer.incarnation = 1;
    answer.from = 2;
    answer.to = 3;
    answer.size = 4;
    answer.offset = 5;
    answer.bytes = {0xc0, 0xff, 0xee};
    return answer;
}

template <typename T>
std::vector<std::uint8_t> Encoded(const T &message)
{
    std::vector<std::uint8_t> bytes(T::IdlType().SerializedSize(message));
    EXPECT_EQ(T::IdlType().Serialize(message, bytes), bytes.size());
    return bytes;
}

template <typename T>
T Decoded(const char *hex)
{
    T message;
    EXPECT_TRUE(T::IdlType().Deserialize(BytesOf(hex), message));
    return message;
}

TEST(BackfillBytes, StampsAreAsTheyWere)
{
    EXPECT_EQ(HexOf(PostsCodec::EncodeStamps(Stamps(), First)), StampsBytes);
    EXPECT_EQ(PostsCodec::DecodeStamps(BytesOf(StampsBytes), First), Stamps());
}

TEST(BackfillBytes, SpansAreAsTheyWere)
{
    EXPECT_EQ(HexOf(PostsCodec::EncodeSpans(Spans())), SpansBytes);
    EXPECT_EQ(PostsCodec::DecodeSpans(BytesOf(SpansBytes)), Spans());
}

TEST(BackfillBytes, PostsAreAsTheyWere)
{
    EXPECT_EQ(HexOf(PostsCodec::EncodePosts(Posts(), First)), PostsBytes);
    EXPECT_EQ(PostsCodec::DecodePosts(BytesOf(PostsBytes), First), Posts());
}

TEST(BackfillBytes, AQuestionIsAsItWas)
{
    EXPECT_EQ(HexOf(Encoded(FullQuestion())), QuestionBytes);
    EXPECT_EQ(Decoded<Question>(QuestionBytes), FullQuestion());
}

TEST(BackfillBytes, AnAnswerIsAsItWas)
{
    EXPECT_EQ(HexOf(Encoded(FullAnswer())), AnswerBytes);
    EXPECT_EQ(Decoded<Answer>(AnswerBytes), FullAnswer());
}

}  // namespace
}  // namespace Rabit::Backfill
