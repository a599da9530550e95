#include "types/TypeAnswers.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "wire/NodeReports.h"
#include "wire/TypeFrames.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

class TypeAnswersTest : public ::testing::Test
{
protected:
    // Sends all answers that are due until `end`. Returns the number of bytes that went to the node.
    std::size_t SendUntil(Ns end, const std::string &node = "tool")
    {
        std::size_t bytes = 0;
        while (answers.Due() && *answers.Due() <= end)
        {
            time = std::max(time, *answers.Due());
            const TypeAnswers::Part next = answers.Next();
            const std::size_t size = std::min<std::size_t>(1000, next.Left());
            bytes += next.Node == node ? size : 0;
            answers.Sent(size, time);
        }
        time = end;
        return bytes;
    }

    Ns time = 1s;
    std::map<std::uint64_t, std::string> texts{{1, std::string(2500, 'a')},
                                               {2, std::string(10, 'b')},
                                               {3, std::string(TypeFrames::LargestText + 1, 'c')}};
    TypeAnswers answers{[this](std::uint64_t definition) -> std::shared_ptr<const std::string>
                        {
                            const auto found = texts.find(definition);
                            return found == texts.end() ? nullptr
                                                        : std::make_shared<std::string>(found->second);
                        }};
};

TEST_F(TypeAnswersTest, WhoAsksGetsTheWholeTextOnce)
{
    answers.Asked("tool", 1, 0, 1s);
    EXPECT_EQ(answers.Next().Node, "tool");
    EXPECT_EQ(answers.Next().First, 0u);
    EXPECT_EQ(SendUntil(60s), 2500u);
    EXPECT_FALSE(answers.Due().has_value());
}

TEST_F(TypeAnswersTest, PartsKeepTheirDistance)
{
    answers.Asked("tool", 1, 0, 1s);
    answers.Sent(1000, 1s);
    EXPECT_EQ(answers.Due(), 1s + TypeAnswers::PartGap);
}

TEST_F(TypeAnswersTest, WhoLacksTheRestGetsTheRest)
{
    answers.Asked("tool", 1, 2000, 1s);
    EXPECT_EQ(SendUntil(60s), 500u);
}

TEST_F(TypeAnswersTest, AHashThatNobodyHasIsCountedAndNotAnswered)
{
    answers.Asked("tool", 99, 0, 1s);
    EXPECT_FALSE(answers.Due().has_value());
    EXPECT_EQ(answers.Unknown(), 1u);
}

TEST_F(TypeAnswersTest, ATextThatIsTooLargeOrAPlaceBehindItsEndIsNotAnswered)
{
    answers.Asked("tool", 3, 0, 1s);
    answers.Asked("tool", 2, 10, 1s);
    EXPECT_FALSE(answers.Due().has_value());
}

TEST_F(TypeAnswersTest, AQuestionThatIsBeingAnsweredIsNotAnsweredTwice)
{
    answers.Asked("tool", 1, 0, 1s);
    answers.Asked("tool", 1, 0, 1s);
    EXPECT_EQ(SendUntil(60s), 2500u);
}

TEST_F(TypeAnswersTest, WhoAsksWithoutEndIsAnsweredOnceInTwoSecondsAtLast)
{
    std::size_t bytes = 0;
    for (Ns now = 1s; now < 101s; now += 10ms)
    {
        answers.Asked("tool", 1, 0, now);
        bytes += SendUntil(now);
    }
    EXPECT_LE(bytes, 2500u * (100 / 2 + 7));
    EXPECT_GE(bytes, 2500u * 45);
}

TEST_F(TypeAnswersTest, WhoAsksAgainLaterIsAnsweredAtOnce)
{
    for (Ns now = 1s; now < 10s; now += 10ms)
    {
        answers.Asked("tool", 1, 0, now);
        SendUntil(now);
    }
    answers.Asked("tool", 1, 0, 20s);
    EXPECT_EQ(SendUntil(21s), 2500u);
}

TEST_F(TypeAnswersTest, ManyWhoAskWaitForEachOtherAndThoseBeyondAreCounted)
{
    for (std::size_t i = 0; i < 2 * TypeAnswers::MostWaiting; ++i)
    {
        answers.Asked("tool" + std::to_string(i), 1, 0, 1s);
    }
    EXPECT_EQ(answers.Dropped(), TypeAnswers::MostWaiting);
    EXPECT_EQ(SendUntil(60s, "tool0"), 2500u);
}

TEST_F(TypeAnswersTest, NamesWithoutEndFillNoMemory)
{
    for (std::size_t i = 0; i < 100000; ++i)
    {
        answers.Asked("tool" + std::to_string(i), 2, 0, 1s + Ns(i));
        SendUntil(1s + Ns(i), "tool" + std::to_string(i));
    }
    EXPECT_GE(answers.Dropped(), 100000u - TypeAnswers::MostRemembered);
}

TEST_F(TypeAnswersTest, ReportsOfOneKindAreLimitedTogether)
{
    const auto line = [](std::uint32_t number)
    { return NodeReports::NameOf(NodeReports::Kind::LinesFrom, number); };
    texts[line(1)] = texts[line(2)] = std::string(100, 'l');
    answers.Asked("tool", line(1), 0, 1s);
    EXPECT_EQ(SendUntil(1s), 100u);
    answers.Asked("tool", line(2), 0, 1s + TypeAnswers::ShortestGap / 2);
    EXPECT_FALSE(answers.Due().has_value());
    answers.Asked("tool", line(2), 0, 1s + TypeAnswers::ShortestGap);
    EXPECT_TRUE(answers.Due().has_value());
}

TEST_F(TypeAnswersTest, EchoesAreAnsweredAtAnyTimeButTheShortestGap)
{
    for (std::uint32_t i = 0; i < 10; ++i)
    {
        const auto echo = NodeReports::NameOf(NodeReports::Kind::Echo, i);
        texts[echo] = "12345678";
        answers.Asked("tool", echo, 0, time);
        EXPECT_EQ(SendUntil(time + TypeAnswers::ShortestGap), 8u) << i;
    }
}

TEST_F(TypeAnswersTest, ALaterReportOfAKindTakesThePlaceOfOneThatHasNotBegun)
{
    const auto echo = [](std::uint32_t number)
    { return NodeReports::NameOf(NodeReports::Kind::Echo, number); };
    texts[echo(1)] = texts[echo(2)] = std::string(8, 'e');
    answers.Asked("other", 1, 0, 1s);
    answers.Asked("tool", echo(1), 0, 1s);
    answers.Asked("tool", echo(2), 0, 1s);
    answers.Sent(2500, 1s);
    EXPECT_EQ(answers.Next().Definition, echo(2));
    EXPECT_EQ(SendUntil(60s), 8u);
}

TEST_F(TypeAnswersTest, AReportThatHasBegunIsSentToItsEnd)
{
    const auto line = [](std::uint32_t number)
    { return NodeReports::NameOf(NodeReports::Kind::LinesFrom, number); };
    texts[line(1)] = texts[line(2)] = std::string(2000, 'l');
    answers.Asked("tool", line(1), 0, 1s);
    answers.Sent(1000, 1s);
    answers.Asked("tool", line(2), 0, 1s);
    EXPECT_EQ(answers.Next().Definition, line(1));
}

TEST(TypeAnswers, NoTextIsComposedForAQuestionThatIsDropped)
{
    std::size_t composed = 0;
    TypeAnswers answers(
        [&composed](std::uint64_t)
        {
            ++composed;
            return std::make_shared<std::string>("text");
        });
    for (std::size_t i = 0; i < 3 * TypeAnswers::MostWaiting; ++i)
    {
        answers.Asked("tool" + std::to_string(i), 1, 0, 1s);
    }
    EXPECT_EQ(composed, TypeAnswers::MostWaiting);
}

TEST_F(TypeAnswersTest, AnAnswerUnderWayIsThatOfItsQuestion)
{
    answers.Asked("tool", 1, 0, 1s);
    texts[1] = "shorter";
    EXPECT_EQ(answers.Next().Text->size(), 2500u);
}

}  // namespace
}  // namespace Rabit
