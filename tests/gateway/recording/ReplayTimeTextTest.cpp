#include <gtest/gtest.h>

#include "recording/replay/TimeText.h"

namespace Rabit::Replay
{
namespace
{

constexpr Time Begin = 1'795'406'646'250'000'000;

TEST(ReplayTimeText, SecondsCountFromTheBeginning)
{
    EXPECT_EQ(TimeOf("0", Begin), Begin);
    EXPECT_EQ(TimeOf("12.5", Begin), Begin + 12'500'000'000);
}

TEST(ReplayTimeText, ADateIsUtc)
{
    EXPECT_EQ(TimeOf("1970-01-01T00:00:01", Begin), 1'000'000'000U);
    EXPECT_EQ(TimeOf("1970-01-01T00:00:01Z", Begin), 1'000'000'000U);
    EXPECT_EQ(TimeOf("1970-01-02T00:00:00.25", Begin), 86'400'250'000'000U);
    EXPECT_EQ(TimeOf(TextOf(Begin), 0), Begin);
}

TEST(ReplayTimeText, WhatIsNeitherIsRefused)
{
    for (const char *text :
         {"", "-1", "1e400", "nan", "inf", "12s", "1 ", " 1", "2026-11-23", "2026-11-23T04:04",
          "2026-13-23T04:04:06", "2026-11-23T04:04:06x", "2026-11-23T04:04:06.5.5", "2026-11-23T04:04:061",
          "1960-01-01T00:00:00", "9999999999999"})
    {
        EXPECT_FALSE(TimeOf(text, Begin)) << text;
    }
}

}  // namespace
}  // namespace Rabit::Replay
