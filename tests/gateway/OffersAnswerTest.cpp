#include "presence/OffersAnswer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

class OffersAnswerTest : public ::testing::Test
{
protected:
    static constexpr std::size_t Part = 100;

    // Begins, and sends the announcement once, long ago.
    void Begin(std::size_t size)
    {
        answer.Begin(size);
        while (answer.Due())
        {
            answer.Said(std::min(Part, answer.Left()), *answer.Due());
        }
    }

    // Lets time pass to the next part, sends it, and returns the time.
    Ns Say()
    {
        const Ns due = answer.Due().value();
        answer.Said(std::min(Part, answer.Left()), due);
        return due;
    }

    std::uint64_t chance = 0;
    OffersAnswer answer{[this] { return chance; }};
};

TEST_F(OffersAnswerTest, IsSaidOnceAtTheBeginning)
{
    answer.Begin(250);
    std::vector<std::size_t> from;
    while (answer.Due())
    {
        from.push_back(answer.From());
        Say();
    }
    EXPECT_EQ(from, (std::vector<std::size_t>{0, 100, 200}));
}

TEST_F(OffersAnswerTest, IsSaidAgainToWhoAsksFromWhereItIsLacking)
{
    Begin(250);
    EXPECT_FALSE(answer.Due());
    answer.Asked(100, 0, 10s);
    EXPECT_EQ(answer.Due(), Ns(10s));
    EXPECT_EQ(answer.From(), 100u);
    EXPECT_EQ(Say(), Ns(10s));
    EXPECT_EQ(Say(), Ns(10s + OffersAnswer::PartGap));
    EXPECT_FALSE(answer.Due());
}

TEST_F(OffersAnswerTest, TheMoreAreAskedAtOnceTheMoreTheySpread)
{
    Begin(50);
    chance = 20'000'000;
    answer.Asked(0, 10, 10s);
    EXPECT_EQ(answer.Due(), Ns(10s + 20ms));
}

TEST_F(OffersAnswerTest, AllWhoAskBeforeItIsSaidAreAnsweredTogether)
{
    Begin(250);
    chance = 7'000'000;
    answer.Asked(200, 10, 10s);
    answer.Asked(100, 10, 10s + 1ms);
    EXPECT_EQ(answer.Due(), Ns(10s + 7ms));
    EXPECT_EQ(answer.From(), 100u);
}

TEST_F(OffersAnswerTest, WhoAsksForWhatWasJustSaidHasItOnItsWay)
{
    Begin(50);
    answer.Asked(0, 0, 10s);
    Say();
    answer.Asked(0, 0, 10s + 49ms);
    EXPECT_FALSE(answer.Due());
}

TEST_F(OffersAnswerTest, WhoAsksMeanwhileForAnEarlierPartIsAnsweredAfterwards)
{
    Begin(250);
    answer.Asked(0, 0, 10s);
    Say();
    Say();
    answer.Asked(200, 0, 10s);
    answer.Asked(100, 0, 10s);
    EXPECT_EQ(answer.From(), 200u);
    Say();
    EXPECT_EQ(answer.From(), 100u);
    Say();
    Say();
    EXPECT_FALSE(answer.Due());
}

TEST_F(OffersAnswerTest, ThoseWhoAskWithoutEndAreAnsweredMoreAndMoreSeldom)
{
    Begin(50);
    std::vector<Ns> gaps;
    Ns last = 10s;
    for (Ns now = 10s; now < 20s; now += 5ms)
    {
        answer.Asked(0, 0, now);
        if (answer.Due() && *answer.Due() <= now)
        {
            answer.Said(50, now);
            gaps.push_back(now - last);
            last = now;
        }
    }
    std::vector<Ns> expected{0ms, 50ms};
    expected.resize(1 + OffersAnswer::QuickAnswers, 100ms);
    expected.insert(expected.end(), {200ms, 400ms, 800ms, 1600ms, 2s, 2s});
    EXPECT_EQ(gaps, expected);
}

TEST_F(OffersAnswerTest, TheFirstRequestOfAnAskerIsAnsweredSoonHoweverManyOthersAsk)
{
    Begin(50);
    Ns now = 10s;
    Ns last = now;
    for (; now < 20s; now += 5ms)
    {
        answer.Asked(0, 0, now, 1);
        if (answer.Due() && *answer.Due() <= now)
        {
            answer.Said(50, now);
            last = now;
        }
    }
    ASSERT_EQ(answer.Due(), last + OffersAnswer::LongestGap);
    answer.Asked(0, 0, now, 2);
    ASSERT_TRUE(answer.Due());
    EXPECT_LE(*answer.Due(), std::max(now, last + OffersAnswer::NewAskerGap));
}

TEST_F(OffersAnswerTest, TheFirstRequestOfAnAskerIsAnsweredSoonAlsoIfItCameBetweenTwoParts)
{
    Begin(200);
    Ns now = 10s;
    for (; now < 40s; now += 5ms)
    {
        answer.Asked(0, 0, now, 1);
        if (answer.Due() && *answer.Due() <= now)
        {
            answer.Said(Part, now);
        }
    }
    answer.Asked(0, 0, now, 1);
    ASSERT_EQ(answer.From(), 0u);
    Say();
    answer.Asked(0, 0, now, 2);
    const Ns end = Say();
    ASSERT_TRUE(answer.Due());
    EXPECT_LE(*answer.Due(), end + 2 * OffersAnswer::NewAskerGap);
}

TEST_F(OffersAnswerTest, NewAskersWithoutEndGetThreeAnswersASecond)
{
    Begin(50);
    std::uint64_t asker = 0;
    int answers = 0;
    for (Ns now = 10s; now < 40s; now += 5ms)
    {
        answer.Asked(0, 0, now, ++asker);
        if (answer.Due() && *answer.Due() <= now)
        {
            answer.Said(50, now);
            ++answers;
        }
    }
    EXPECT_LE(answers, 30s / OffersAnswer::NewAskerGap + OffersAnswer::QuickAnswers);
}

TEST_F(OffersAnswerTest, TheMorePartsThereAreTheMoreSeldomItIsSaid)
{
    Begin(1000);
    answer.Asked(0, 0, 10s);
    for (int part = 0; part < 10; ++part)
    {
        Say();
    }
    answer.Asked(0, 0, 10s + 550ms);
    EXPECT_EQ(answer.Due(), Ns(10s + 450ms + 10 * OffersAnswer::ShortestGap));
}

TEST_F(OffersAnswerTest, AfterSomeQuietWhoAsksIsAnsweredAtOnceAgain)
{
    Begin(50);
    Ns now = 10s;
    for (; now < 20s; now += 5ms)
    {
        answer.Asked(0, 0, now);
        if (answer.Due() && *answer.Due() <= now)
        {
            answer.Said(50, now);
        }
    }
    now += OffersAnswer::Quiet;
    answer.Asked(0, 0, now);
    EXPECT_LE(Say(), now);
    now += 60ms;
    answer.Asked(0, 0, now);
    EXPECT_EQ(answer.Due(), now);
}

TEST_F(OffersAnswerTest, WhoAsksForWhatIsBeyondTheEndIsNotAnswered)
{
    Begin(50);
    answer.Asked(50, 0, 10s);
    EXPECT_FALSE(answer.Due());
}

TEST_F(OffersAnswerTest, QuestionsThatCameBeforeItCanHaveBeenHeardHaveCrossedWithIt)
{
    Begin(100);
    answer.Asked(0, 0, 10s);
    answer.Said(100, 10s, 700ms);
    answer.Asked(0, 0, 10s + 1300ms);
    EXPECT_FALSE(answer.Due());
    answer.Asked(0, 0, 10s + 1400ms);
    EXPECT_TRUE(answer.Due());
}

}  // namespace
}  // namespace Rabit
