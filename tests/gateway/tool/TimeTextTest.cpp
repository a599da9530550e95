#include "TimeText.h"

#include <rabit/base/UtcText.h>

#include <gtest/gtest.h>

#include <limits>

namespace Rabit::Tool
{
namespace
{

constexpr std::uint64_t Second = 1'000'000'000;
constexpr std::uint64_t Begin = 1'795'406'647 * Second;  // 2026-11-23 04:04:07

TEST(TimeText, ReadsSecondsSinceTheBeginning)
{
    EXPECT_EQ(TimeOf("0", Begin), Begin);
    EXPECT_EQ(TimeOf("12.5", Begin), Begin + 12 * Second + Second / 2);
}

TEST(TimeText, WritesADurationInTheUnitThatFits)
{
    EXPECT_EQ(DurationText(0.0003456), "0.35 ms");
    EXPECT_EQ(DurationText(0.9), "900.00 ms");
    EXPECT_EQ(DurationText(12.4), "12.40 s");
    EXPECT_EQ(DurationText(119.0), "119.00 s");
    EXPECT_EQ(DurationText(2313.1382), "38.6 min");
    EXPECT_EQ(DurationText(7200.0), "2.0 h");
    EXPECT_EQ(DurationText(std::numeric_limits<double>::quiet_NaN()), "-");
    EXPECT_EQ(DurationText(std::numeric_limits<double>::infinity()), "-");
}

TEST(TimeText, ReadsUtc)
{
    for (const char *text : {"2026-11-23T04:04:07", "2026-11-23T04:04:07Z", "2026-11-23 04:04:07",
                             "2026-11-23 04:04:07.000", "2026-11-23T04:04:07.0000000009Z"})
    {
        EXPECT_EQ(TimeOf(text, 5), Begin) << text;
    }
    EXPECT_EQ(TimeOf("2026-11-23T04:04:07.25Z", 5), Begin + Second / 4);
    EXPECT_EQ(TimeOf("1970-01-02T00:00:00.25", 5), 86'400 * Second + Second / 4);
    EXPECT_EQ(TimeOf("2028-02-29T23:59:59", 5), 1'835'481'599 * Second);
}

TEST(TimeText, RefusesAllElse)
{
    for (const char *text : {"",
                             "now",
                             "-1",
                             "1e400",
                             "nan",
                             "inf",
                             "1s",
                             "1 ",
                             " 1",
                             "9999999999999",
                             "2026-11-23",
                             "2026-11-23T04:04",
                             "2026-11-23x04:04:07",
                             "2026-11-23T04:04:07x",
                             "2026-11-23T04:04:07.",
                             "2026-11-23T04:04:07.5.5",
                             "2026-11-23T04:04:07.5 h",
                             "2026-11-23T04:04:07ZZ",
                             "2026-11-23T04:04:071",
                             "2026-11-23T 4:04:07",
                             "2026-1-23T04:04:07"})
    {
        EXPECT_FALSE(TimeOf(text, Begin)) << text;
    }
}

TEST(TimeText, RefusesDaysAndTimesThatDoNotExist)
{
    for (const char *text : {"2026-02-31T04:04:07", "2026-02-30 04:04:07", "2026-02-29T04:04:07",
                             "2026-13-23T04:04:07", "2026-00-23T04:04:07", "2026-11-00T04:04:07",
                             "2026-11-23T24:04:07", "2026-11-23T04:60:07", "2026-11-23T04:04:60"})
    {
        EXPECT_FALSE(TimeOf(text, Begin)) << text;
    }
}

TEST(TimeText, RefusesMomentsThatDoNotFit)
{
    EXPECT_FALSE(TimeOf("1960-01-01T00:00:00", Begin));
    EXPECT_FALSE(TimeOf("2600-01-01T00:00:00", Begin));
    EXPECT_FALSE(TimeOf("1", std::numeric_limits<std::uint64_t>::max()));
}

TEST(TimeText, WritesUtcAsItIsRead)
{
    EXPECT_EQ(UtcText(Begin + Second / 4), "2026-11-23T04:04:07.250Z");
    EXPECT_EQ(TimeOf(UtcText(Begin + Second / 4), 0), Begin + Second / 4);
    EXPECT_EQ(UtcText(std::numeric_limits<std::uint64_t>::max()), "2554-07-21T23:34:33.709Z");
}

}  // namespace
}  // namespace Rabit::Tool
