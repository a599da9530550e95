#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/keys/TokenGuard.h>

#include <string>

namespace
{
using namespace std::chrono_literals;
using Rabit::Keys::TokenGuard;
using testing::HasSubstr;

const std::string Right = "0123456789abcdef0123456789abcdef";

class TokenGuardTest : public testing::Test
{
protected:
    TokenGuard _guard{Right};
    TokenGuard::Time _now{std::chrono::hours(1)};

    static TokenGuard::Address From(const std::string &text) { return boost::asio::ip::make_address(text); }
    void Wrong(const std::string &from, int times)
    {
        for (int i = 0; i < times; ++i)
            EXPECT_FALSE(_guard.IsRight(From(from), "wrong", _now));
    }
    std::chrono::milliseconds Pause(const std::string &from) const
    {
        return _guard.PauseFor(From(from), _now);
    }
};

TEST_F(TokenGuardTest, KnowsTheTokenAndNothingElse)
{
    EXPECT_TRUE(_guard.IsRight(From("10.0.0.7"), Right, _now));
    for (const std::string &shown : {std::string(), Right.substr(1), Right.substr(0, 31), Right + "0",
                                     Right + '\0', "X" + Right.substr(1), std::string(100'000, 'x')})
        EXPECT_FALSE(_guard.IsRight(From("10.0.0.7"), shown, _now));
}

TEST_F(TokenGuardTest, BecomesSlowerWithEachWrongTokenOfAnAddressAndForgetsThem)
{
    Wrong("10.0.0.7", 5);
    EXPECT_EQ(Pause("10.0.0.7"), 0ms) << "a few may be mistakes";
    Wrong("10.0.0.7", 1);
    const auto first = Pause("10.0.0.7");
    EXPECT_GT(first, 0ms);
    Wrong("10.0.0.7", 1);
    EXPECT_GT(Pause("10.0.0.7"), first);
    Wrong("10.0.0.7", 1000);
    EXPECT_EQ(Pause("10.0.0.7"), TokenGuard::LongestPause);
    EXPECT_EQ(Pause("10.0.0.8"), TokenGuard::LongestPause) << "so many are an attack: strangers wait as well";
    _now += 15 * TokenGuard::ForgetsOneIn;
    EXPECT_EQ(Pause("10.0.0.7"), 0ms) << "the attack is over";
    EXPECT_EQ(Pause("10.0.0.8"), 0ms);
}

TEST_F(TokenGuardTest, LetsNobodyPayForAFewWrongTokensOfOthers)
{
    Wrong("10.0.0.7", 20);
    EXPECT_GT(Pause("10.0.0.7"), 0ms);
    EXPECT_EQ(Pause("10.0.0.8"), 0ms);
}

TEST_F(TokenGuardTest, LetsWhoWasRightNotPayForAnAttackOfManyAddresses)
{
    EXPECT_TRUE(_guard.IsRight(From("10.0.0.7"), Right, _now));
    for (int i = 0; i < 200; ++i)
        Wrong("10.1.0." + std::to_string(i), 1);
    EXPECT_EQ(Pause("10.0.0.7"), 0ms);
    EXPECT_GT(Pause("10.0.0.8"), 0ms);
    EXPECT_LE(Pause("10.0.0.8"), TokenGuard::LongestPause) << "the right token gets through from anywhere";
}

TEST_F(TokenGuardTest, TakesNeighboursInOneIpv6NetworkForOne)
{
    for (int i = 1; i < 10; ++i)
        Wrong("2001:db8::" + std::to_string(i), 1);
    EXPECT_GT(Pause("2001:db8::ffff"), 0ms);
    EXPECT_EQ(Pause("2001:db8:0:1::1"), 0ms);
    Wrong("::ffff:10.0.0.7", 10);
    EXPECT_GT(Pause("10.0.0.7"), 0ms) << "one and the same address";
}

TEST_F(TokenGuardTest, RemembersWhoGuessesMostWhenThereAreTooManyAddresses)
{
    EXPECT_TRUE(_guard.IsRight(From("10.0.0.7"), Right, _now));
    Wrong("10.0.0.7", 10);
    for (int i = 0; i < 1000; ++i)
        Wrong("10." + std::to_string(1 + i / 250) + ".0." + std::to_string(i % 250), 1);
    EXPECT_GT(Pause("10.0.0.7"), 0ms);
}

TEST_F(TokenGuardTest, LogsTheFirstWrongTokenAtOnceAndThenOneLineForAllOfAWhile)
{
    EXPECT_EQ(_guard.Line(_now), std::nullopt);
    Wrong("10.0.0.7", 1);
    EXPECT_EQ(_guard.Line(_now), "The web page was shown a wrong token: from 10.0.0.7 once");
    Wrong("10.0.0.7", 3);
    Wrong("2001:db8::1", 1);
    EXPECT_EQ(_guard.Line(_now), std::nullopt);
    _now += TokenGuard::BetweenLines;
    EXPECT_EQ(_guard.Line(_now),
              "The web page was shown a wrong token: from 10.0.0.7 3 times, from 2001:db8::1 once");
    _now += TokenGuard::BetweenLines;
    EXPECT_EQ(_guard.Line(_now), std::nullopt) << "nothing is new";
}

TEST_F(TokenGuardTest, NamesAFewAddressesInALineAndCountsTheRest)
{
    for (int i = 0; i < 200; ++i)
        Wrong("10.1.0." + std::to_string(i), 1);
    const auto line = _guard.Line(_now);
    ASSERT_NE(line, std::nullopt);
    EXPECT_LT(line->size(), 200u);
    EXPECT_THAT(*line, HasSubstr("from others 196 times"));
}

}  // namespace
