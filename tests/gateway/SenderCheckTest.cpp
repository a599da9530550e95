#include "presence/SenderCheck.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(SenderCheck, ANodeSpeaksForItselfAlone)
{
    SenderCheck check;
    EXPECT_TRUE(check.MaySpeakFor("uav1", "uav1", 1s));
    EXPECT_FALSE(check.MaySpeakFor("uav1", "ground", 1s));
    EXPECT_FALSE(check.MaySpeakFor("uav1", "uav11", 1s));
    EXPECT_EQ(check.Refused(), 2u);
}

TEST(SenderCheck, AProgramThatIsNoNodeSpeaksForNobody)
{
    SenderCheck check;
    EXPECT_FALSE(check.MaySpeakFor("", "uav1", 1s));
    EXPECT_FALSE(check.MaySpeakFor("", "", 1s));
    EXPECT_EQ(check.Refused(), 2u);
}

TEST(SenderCheck, ReportsWhoSpeaksForWhomWhileItLasts)
{
    SenderCheck check;
    EXPECT_TRUE(check.Problems(1s).empty());
    check.MaySpeakFor("uav1", "ground", 1s);
    check.MaySpeakFor("", "ground", 2s);
    const auto problems = check.Problems(5s);
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0].reason,
              "a program that is no node sends in the name of `ground`; it is not listened to");
    EXPECT_EQ(problems[1].subject, "node ground");
    EXPECT_EQ(problems[1].node, "uav1");
    EXPECT_EQ(problems[1].reason, "node `uav1` sends in the name of `ground`; it is not listened to");
    EXPECT_EQ(check.Problems(1s + SenderCheck::Memory + 1ns).size(), 1u);
    EXPECT_TRUE(check.Problems(2s + SenderCheck::Memory + 1ns).empty());
}

TEST(SenderCheck, RemembersABoundedNumberAndTheNewestOfThem)
{
    SenderCheck check;
    for (std::size_t i = 0; i < 10 * SenderCheck::MostRemembered; ++i)
    {
        check.MaySpeakFor("uav1", "made-up-" + std::to_string(i), 1s + std::chrono::nanoseconds(i));
    }
    const auto problems = check.Problems(2s);
    EXPECT_EQ(problems.size(), SenderCheck::MostRemembered);
    EXPECT_EQ(check.Refused(), 10 * SenderCheck::MostRemembered);
}

}  // namespace
}  // namespace Rabit
