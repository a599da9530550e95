#include "presence/Introductions.h"

#include <gtest/gtest.h>

#include <set>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Reason = Introductions::Reason;

std::string Name(int i)
{
    return std::string("n").append(std::to_string(i));
}

TEST(Introductions, TheOnlyOtherNodeAnswersANewcomerAtOnce)
{
    Introductions introductions([] { return ~std::uint64_t{0}; });
    EXPECT_FALSE(introductions.Due());
    introductions.Ask("uav1", Reason::Appeared, 0, 1s);
    EXPECT_EQ(introductions.Due(), 1s);
    EXPECT_TRUE(introductions.TakeBeats(1s));
    EXPECT_FALSE(introductions.Due());
    EXPECT_FALSE(introductions.TakeBeats(2s));
}

TEST(Introductions, ThoseWhoComeTogetherAreAnsweredTogether)
{
    Introductions introductions([] { return 0; });
    introductions.Ask("uav1", Reason::Appeared, 0, 1s);
    ASSERT_TRUE(introductions.TakeBeats(1s));
    introductions.Ask("uav2", Reason::Appeared, 0, 1s);
    introductions.Ask("uav3", Reason::Heard, 0, 1001ms);
    EXPECT_EQ(introductions.Due(), 1010ms);
    EXPECT_TRUE(introductions.TakeBeats(1010ms));
    EXPECT_FALSE(introductions.Due());
}

TEST(Introductions, OneThatComesAgainAndAgainIsAnsweredOnceInAWhile)
{
    Introductions introductions([] { return 0; });
    int answers = 0;
    for (auto now = 0ms; now < 50s; now += 100ms)
    {
        introductions.Ask("crasher", Reason::Appeared, 0, now);
        answers += introductions.TakeBeats(now) ? 1 : 0;
    }
    EXPECT_EQ(answers, 10);
}

TEST(Introductions, OneThatComesAgainAndAgainDoesNotKeepOthersFromBeingAnswered)
{
    Introductions introductions([] { return 0; });
    for (auto now = 0ms; now < 50s; now += 100ms)
    {
        introductions.Ask("crasher", Reason::Appeared, 0, now);
        introductions.TakeBeats(now);
    }
    introductions.Ask("uav1", Reason::Appeared, 0, 50s);
    EXPECT_EQ(introductions.Due(), 50s);
}

TEST(Introductions, ACrowdIsAnsweredSomeTimesInARowAndThenOnceASecond)
{
    Introductions introductions([] { return 0; });
    int answers = 0;
    int name = 0;
    for (auto now = 0ms; now < 100s; now += 20ms)
    {
        introductions.Ask(Name(++name), Reason::Appeared, 0, now);
        answers += introductions.TakeBeats(now) ? 1 : 0;
    }
    EXPECT_GE(answers, 100);
    EXPECT_LE(answers, 100 + Introductions::MostInARow);
}

TEST(Introductions, AfterARestACrowdIsAnsweredAgain)
{
    Introductions introductions([] { return 0; });
    for (int i = 0; i < 100; ++i)
    {
        introductions.Ask(Name(i), Reason::Appeared, 0, 1s);
    }
    introductions.TakeBeats(1s);
    introductions.Ask("late", Reason::Appeared, 0, 1500ms);
    EXPECT_FALSE(introductions.Due());
    introductions.Ask("later", Reason::Appeared, 0, 2s);
    EXPECT_TRUE(introductions.Due());
}

TEST(Introductions, TheMoreNodesThereAreTheMoreTheySpreadTheirAnswers)
{
    std::uint64_t chance = 0;
    const auto latest = [&chance](std::size_t others)
    {
        Introductions::Duration most{0};
        for (int i = 0; i < 1000; ++i)
        {
            Introductions introductions([&chance] { return chance += 0x9e3779b97f4a7c15; });
            introductions.Ask("uav1", Reason::Appeared, others, 1s);
            most = std::max(most, *introductions.Due() - 1s);
        }
        return most;
    };
    EXPECT_EQ(latest(0), 0ns);
    EXPECT_GT(latest(10), 18ms);
    EXPECT_LE(latest(10), 20ms);
    EXPECT_GT(latest(100'000), 90ms);
    EXPECT_LE(latest(100'000), 100ms);
}

}  // namespace
}  // namespace Rabit
