// When this node answers the nonces of others, and how many.
#include "envelope/OwnAnswers.h"

#include <gtest/gtest.h>

namespace
{

using namespace Rabit::Envelope;

constexpr TimePoint AnswersStart{std::chrono::hours(1)};

Nonce NonceNumber(std::size_t number)
{
    return {1, static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8)};
}

TEST(EnvelopeOwnAnswers, AreGivenOnce)
{
    OwnAnswers answers;
    EXPECT_TRUE(answers.Take(AnswersStart).empty());
    answers.Ask(NonceNumber(1), true);
    answers.Ask(NonceNumber(1), true);
    answers.Ask(Nonce{}, true);
    EXPECT_EQ(answers.Take(AnswersStart), std::vector{NonceNumber(1)});
    EXPECT_TRUE(answers.Take(AnswersStart + OwnAnswers::Spacing).empty());
}

TEST(EnvelopeOwnAnswers, KeepADistance)
{
    OwnAnswers answers;
    answers.Ask(NonceNumber(1), true);
    answers.Take(AnswersStart);
    answers.Ask(NonceNumber(2), true);
    answers.Ask(NonceNumber(3), false);
    EXPECT_TRUE(answers.Take(AnswersStart + OwnAnswers::Spacing - std::chrono::milliseconds(1)).empty());
    EXPECT_EQ(answers.Take(AnswersStart + OwnAnswers::Spacing),
              (std::vector{NonceNumber(2), NonceNumber(3)}));
}

TEST(EnvelopeOwnAnswers, GoToVerifiedClaimsFirstHoweverManyOthersAsk)
{
    OwnAnswers answers;
    answers.Ask(NonceNumber(1), true);
    for (std::size_t number = 1; number <= 1000; ++number)
    {
        answers.Ask(NonceNumber(number), false);
    }
    const std::vector<Nonce> taken = answers.Take(AnswersStart);
    ASSERT_EQ(taken.size(), Claim::MostAnswers);
    EXPECT_EQ(taken.front(), NonceNumber(1));
    EXPECT_EQ(std::count(taken.begin(), taken.end(), NonceNumber(1)), 1);
}

TEST(EnvelopeOwnAnswers, OfUnverifiedClaimsAreThoseOfTheNewest)
{
    OwnAnswers answers;
    for (std::size_t number = 1; number <= 1000; ++number)
    {
        answers.Ask(NonceNumber(number), false);
    }
    const std::vector<Nonce> taken = answers.Take(AnswersStart);
    EXPECT_EQ(taken.front(), NonceNumber(1001 - Claim::MostAnswers));
    EXPECT_EQ(taken.back(), NonceNumber(1000));
}

}  // namespace
