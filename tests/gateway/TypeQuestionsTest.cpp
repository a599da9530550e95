#include "types/TypeQuestions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "names/TypeDefinition.h"
#include "wire/NodeReports.h"

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

    std::optional<std::string> Add(const std::string &node, const TypeFrames::Part &part)
    {
        const auto answer = questions.Add(node, part);
        return answer ? std::optional(answer->Text) : std::nullopt;
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
    EXPECT_FALSE(Add("uav1", Part(10, text.size() - 10)).has_value());
    EXPECT_EQ(Add("uav1", Part(0, 12)), text);
    EXPECT_TRUE(questions.IsEmpty());
}

TEST_F(TypeQuestionsTest, OnlyWhatIsLackingIsAskedForAgain)
{
    Add("uav1", Part(0, 7));
    EXPECT_EQ(questions.Take(1s, 8).front().From, 7u);
}

TEST_F(TypeQuestionsTest, AWholeTextWithAnotherHashIsDroppedAndAskedForAgain)
{
    std::string other = text;
    other[9] = 'X';
    EXPECT_FALSE(Add("uav1", Part(other, 0, other.size())).has_value());
    EXPECT_EQ(questions.Wrong(), 1u);
    EXPECT_EQ(questions.Take(1s, 8).front().From, 0u);
    EXPECT_EQ(Add("uav1", Part(0, text.size())), text);
}

TEST_F(TypeQuestionsTest, WhatNobodyAskedThatNodeForIsDropped)
{
    EXPECT_FALSE(Add("uav2", Part(0, text.size())).has_value());
    TypeFrames::Part unasked = Part(0, text.size());
    ++unasked.Definition;
    EXPECT_FALSE(Add("uav1", unasked).has_value());
    EXPECT_EQ(questions.Wrong(), 2u);
}

TEST_F(TypeQuestionsTest, PartsOfTextsOfTwoSizesAreNotMixed)
{
    const std::string longer = "struct  A { long value; };";
    Add("uav1", Part(longer, 0, 20));
    Add("uav1", Part(0, 10));
    EXPECT_EQ(Add("uav1", Part(10, text.size() - 10)), text);
}

TEST_F(TypeQuestionsTest, AnotherNodeMayBeAskedInstead)
{
    questions.Take(1s, 8);
    Add("uav1", Part(0, 7));
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
    questions.LetGo({"uav1", "A", definition});
    EXPECT_TRUE(questions.Want({"uav1", "A", definition + 1000}, 1s));
}

class ReportQuestions : public ::testing::Test
{
protected:
    using Kind = NodeReports::Kind;

    bool Want(const std::string &node, Kind kind, std::uint32_t argument, Ns now)
    {
        return questions.Want({node, "", NodeReports::NameOf(kind, argument)}, now);
    }

    // The node sends that report as a whole.
    auto Answer(const std::string &node, Kind kind, std::uint32_t argument, const std::string &sealed)
    {
        TypeFrames::Part part;
        part.Definition = NodeReports::NameOf(kind, argument);
        part.Of = static_cast<std::uint32_t>(sealed.size());
        part.Bytes = std::span(reinterpret_cast<const std::uint8_t *>(sealed.data()), sealed.size());
        return questions.Add(node, part);
    }

    TypeQuestions questions;
};

TEST_F(ReportQuestions, OneReportOfSeveralNodesIsAskedForAtOnce)
{
    Want("uav1", Kind::Air, 0, 1s);
    Want("uav2", Kind::Air, 0, 1s);
    EXPECT_THAT(questions.Take(1s, 8), SizeIs(2));
    EXPECT_EQ(Answer("uav2", Kind::Air, 0, NodeReports::Sealed("2"))->Text, "2");
    EXPECT_EQ(Answer("uav1", Kind::Air, 0, NodeReports::Sealed("1"))->Text, "1");
    EXPECT_TRUE(questions.IsEmpty());
}

TEST_F(ReportQuestions, NothingIsAskedOfANodeThatIsForgottenUntilItIsWantedAgain)
{
    Want("uav1", Kind::Air, 0, 1s);
    Want("uav1", Kind::Problems, 0, 1s);
    Want("uav2", Kind::Air, 0, 1s);
    questions.Forget("uav1");
    ASSERT_THAT(questions.Take(1s, 8), SizeIs(1));
    Want("uav1", Kind::Air, 0, 1s);
    EXPECT_THAT(questions.Take(1s, 8), SizeIs(1));
}

TEST_F(ReportQuestions, AReportThatIsLetGoIsNotAskedFor)
{
    Want("uav1", Kind::Problems, 0, 1s);
    Want("uav2", Kind::Problems, 0, 1s);
    questions.LetGo({"uav1", "", NodeReports::NameOf(Kind::Problems)});
    const auto asked = questions.Take(1s, 8);
    ASSERT_THAT(asked, SizeIs(1));
    EXPECT_EQ(asked[0].Node, "uav2");
}

TEST_F(ReportQuestions, TellsWhenTheQuestionWasAskedLast)
{
    Want("uav1", Kind::Air, 0, 1s);
    questions.Take(1s, 8);
    questions.Take(2s, 8);
    EXPECT_EQ(Answer("uav1", Kind::Air, 0, NodeReports::Sealed(""))->AskedAt, 2s);
}

TEST_F(ReportQuestions, AReportWithAnotherSealIsDroppedAndAskedForAgain)
{
    Want("uav1", Kind::LastLines, 20, 1s);
    std::string sealed = NodeReports::Sealed("7\nline\n");
    sealed.back() = 'x';
    EXPECT_FALSE(Answer("uav1", Kind::LastLines, 20, sealed).has_value());
    EXPECT_EQ(questions.Wrong(), 1u);
    EXPECT_THAT(questions.Take(1s, 8), SizeIs(1));
}

TEST_F(ReportQuestions, ALaterQuestionOfAKindTakesThePlaceOfTheFormer)
{
    Want("uav1", Kind::LinesFrom, 7, 1s);
    Want("uav1", Kind::LinesFrom, 9, 1s);
    Want("uav1", Kind::LastLines, 9, 1s);
    EXPECT_THAT(questions.Take(1s, 8), SizeIs(2));
}

TEST_F(ReportQuestions, AnEchoIsAskedForOnce)
{
    Want("uav1", Kind::Echo, 1, 1s);
    EXPECT_THAT(questions.Take(1s, 8), SizeIs(1));
    EXPECT_THAT(questions.Take(1h, 8), IsEmpty());
}

TEST_F(ReportQuestions, ASecondAnswerIsNoHarm)
{
    Want("uav1", Kind::Air, 0, 1s);
    Answer("uav1", Kind::Air, 0, NodeReports::Sealed("1"));
    Answer("uav1", Kind::Air, 0, NodeReports::Sealed("1"));
    EXPECT_EQ(questions.Wrong(), 0u);
}

}  // namespace
}  // namespace Rabit
