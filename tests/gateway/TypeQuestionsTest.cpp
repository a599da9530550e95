#include "types/TypeQuestions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "names/TypeDefinition.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class TypeQuestionsTest : public ::testing::Test
{
protected:
    TypeQuestionsTest() { questions.Want({"uav1", "A", definition}, 1s); }

    TypeFrames::Part Part(std::size_t first, std::size_t size) const { return Part(text, first, size); }

    TypeFrames::Part Part(const std::string &of, std::size_t first, std::size_t size) const
    {
        TypeFrames::Part part;
        part.Definition = definition;
        part.First = static_cast<std::uint32_t>(first);
        part.Of = static_cast<std::uint32_t>(of.size());
        part.Bytes = std::span(reinterpret_cast<const std::uint8_t *>(of.data()) + first, size);
        return part;
    }

    const std::string text = "struct A { long value; };";
    const std::uint64_t definition = DefinitionHash("A", text);
    TypeQuestions questions;
};

TEST_F(TypeQuestionsTest, WhatIsWantedIsAskedForAtOnceAndThenLessAndLess)
{
    ASSERT_EQ(questions.NextDue(), 1s);
    const auto asked = questions.Take(1s, 8);
    ASSERT_THAT(asked, SizeIs(1));
    EXPECT_EQ(asked[0].Node, "uav1");
    EXPECT_EQ(asked[0].Definition, definition);
    EXPECT_EQ(asked[0].From, 0u);
    EXPECT_EQ(questions.NextDue(), 1s + TypeQuestions::ShortestGap);
    Ns last = 1s;
    for (int i = 0; i < 10; ++i)
    {
        const Ns due = *questions.NextDue();
        EXPECT_EQ(due - last, std::min<Ns>(TypeQuestions::ShortestGap * (1 << i), TypeQuestions::LongestGap));
        last = due;
        questions.Take(due, 8);
    }
}

TEST_F(TypeQuestionsTest, PartsMakeTheTextInWhateverOrderTheyCome)
{
    EXPECT_FALSE(questions.Add("uav1", Part(10, text.size() - 10)).has_value());
    EXPECT_EQ(questions.Add("uav1", Part(0, 12)), text);
    EXPECT_TRUE(questions.IsEmpty());
}

TEST_F(TypeQuestionsTest, OnlyWhatIsLackingIsAskedForAgain)
{
    questions.Add("uav1", Part(0, 7));
    EXPECT_EQ(questions.Take(1s, 8).front().From, 7u);
}

TEST_F(TypeQuestionsTest, AWholeTextWithAnotherHashIsDroppedAndAskedForAgain)
{
    std::string other = text;
    other[9] = 'X';
    EXPECT_FALSE(questions.Add("uav1", Part(other, 0, other.size())).has_value());
    EXPECT_EQ(questions.Wrong(), 1u);
    EXPECT_EQ(questions.Take(1s, 8).front().From, 0u);
    EXPECT_EQ(questions.Add("uav1", Part(0, text.size())), text);
}

TEST_F(TypeQuestionsTest, WhatNobodyAskedThatNodeForIsDropped)
{
    EXPECT_FALSE(questions.Add("uav2", Part(0, text.size())).has_value());
    TypeFrames::Part unasked = Part(0, text.size());
    ++unasked.Definition;
    EXPECT_FALSE(questions.Add("uav1", unasked).has_value());
    EXPECT_EQ(questions.Wrong(), 2u);
}

TEST_F(TypeQuestionsTest, PartsOfTextsOfTwoSizesAreNotMixed)
{
    const std::string longer = "struct  A { long value; };";
    questions.Add("uav1", Part(longer, 0, 20));
    questions.Add("uav1", Part(0, 10));
    EXPECT_EQ(questions.Add("uav1", Part(10, text.size() - 10)), text);
}

TEST_F(TypeQuestionsTest, AnotherNodeMayBeAskedInstead)
{
    questions.Take(1s, 8);
    questions.Add("uav1", Part(0, 7));
    EXPECT_TRUE(questions.Want({"uav2", "A", definition}, 2s));
    const auto asked = questions.Take(2s, 8);
    ASSERT_THAT(asked, SizeIs(1));
    EXPECT_EQ(asked[0].Node, "uav2");
    EXPECT_EQ(asked[0].From, 0u) << "texts of one hash may differ in comments";
}

TEST_F(TypeQuestionsTest, ToAskTheSameNodeTwiceAsksNoMoreOften)
{
    questions.Take(1s, 8);
    EXPECT_TRUE(questions.Want({"uav1", "A", definition}, 1s));
    EXPECT_THAT(questions.Take(1s, 8), IsEmpty());
}

TEST_F(TypeQuestionsTest, NoMoreAreAskedForThanThereIsRoomFor)
{
    for (std::uint64_t i = 1; i < TypeQuestions::MostWanted; ++i)
    {
        EXPECT_TRUE(questions.Want({"uav1", "A", definition + i}, 1s));
    }
    EXPECT_FALSE(questions.Want({"uav1", "A", definition + 1000}, 1s));
    questions.LetGo(definition);
    EXPECT_TRUE(questions.Want({"uav1", "A", definition + 1000}, 1s));
}

}  // namespace
}  // namespace Rabit
