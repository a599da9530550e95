#include "mirrors/StateVersion.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <limits>

namespace Rabit::StateVersion
{
namespace
{

using namespace std::chrono_literals;

constexpr std::int64_t Now = 1'700'000'000'123'456'789;
// The time after which versions repeat.
constexpr std::int64_t Round = Step << 32;

TEST(StateVersion, WhatABackendRoundsDoesNotChangeTheVersion)
{
    for (const std::int64_t time : {Now, std::int64_t{0}, std::int64_t{-1}, Now + 1, Now * 2, -Now})
    {
        const std::int64_t written = Quantised(time);
        EXPECT_LE(std::abs(written - time), Step + Step / 2) << time;
        for (const std::int64_t rounding : {-500, -1, 0, 1, 500})
        {
            EXPECT_EQ(Of(written + rounding), Of(written)) << time << " by " << rounding;
            EXPECT_TRUE(IsSame(written + rounding, written)) << time << " by " << rounding;
        }
    }
}

TEST(StateVersion, NoTimeHasTheVersionOfNothing)
{
    for (std::int64_t time = Round - 3 * Step; time < Round + 3 * Step; time += 100)
    {
        EXPECT_NE(Of(Quantised(time)), None) << time;
    }
    EXPECT_EQ(Of(Round), None) << "or the test does not meet it";
}

TEST(StateVersion, WhatFollowsWithinAStepIsAnotherVersionAndLater)
{
    for (std::int64_t time : {Now, Round - 3 * Step, -3 * Step})
    {
        std::int64_t written = Quantised(time);
        for (int i = 0; i < 6; ++i)
        {
            const std::int64_t next = Next(written);
            EXPECT_GT(next, written);
            EXPECT_NE(Of(next), Of(written));
            EXPECT_NE(Of(next), None);
            EXPECT_EQ(Quantised(next), next);
            written = next;
        }
    }
}

TEST(StateVersion, ThatCameAgainIsToldApart)
{
    const std::int64_t written = Quantised(Now);
    EXPECT_EQ(Of(written), Of(written + Round));
    EXPECT_FALSE(IsSame(written, written + Round));
}

TEST(StateVersion, TheTimeOfAVersionIsTheLatestThatFits)
{
    const std::int64_t written = Quantised(Now);
    EXPECT_EQ(LatestOf(Of(written), written), written);
    EXPECT_EQ(LatestOf(Of(written), written + 1), written);
    EXPECT_EQ(LatestOf(Of(written), written + 5'000'000'000), written);
    EXPECT_EQ(LatestOf(Of(written), written + Round - 1), written);
    EXPECT_EQ(LatestOf(Of(written), written + Round), written + Round);
    EXPECT_EQ(LatestOf(Of(written), written - 1), written - Round);
}

}  // namespace
}  // namespace Rabit::StateVersion
