#include "recording/merge/TimeText.h"

#include <gtest/gtest.h>

namespace Rabit::Merge
{
namespace
{

constexpr Moment Beginning = 1795406647 * OneSecond;  // 2026-11-23 04:04:07

TEST(TimeText, ReadsSecondsSinceTheBeginning)
{
    EXPECT_EQ(ParseMoment("0", Beginning), Beginning);
    EXPECT_EQ(ParseMoment("12.5", Beginning), Beginning + 12 * OneSecond + OneSecond / 2);
}

TEST(TimeText, ReadsUtc)
{
    for (const char *text : {"2026-11-23T04:04:07Z", "2026-11-23T04:04:07", "2026-11-23 04:04:07.000"})
    {
        EXPECT_EQ(ParseMoment(text, 0), Beginning) << text;
    }
    EXPECT_EQ(ParseMoment("2026-11-23T04:04:07.25Z", 0), Beginning + OneSecond / 4);
}

TEST(TimeText, RefusesAllElse)
{
    for (const char *text :
         {"", "now", "1s", "nan", "inf", "2026-11-23", "2026-13-23T04:04:07", "2026-02-30T04:04:07",
          "2026-11-23T25:04:07", "2026-11-23T04:04:07.5 h", "2026-11-23x04:04:07"})
    {
        EXPECT_FALSE(ParseMoment(text, Beginning).has_value()) << text;
    }
}

TEST(TimeText, WritesUtc)
{
    EXPECT_EQ(DateOf(Beginning + 250 * 1000000), "2026-11-23 04:04:07.250 UTC");
    EXPECT_EQ(DateOf(-1), "?");
}

}  // namespace
}  // namespace Rabit::Merge
