#include "NumberWithin.h"

#include <gtest/gtest.h>

#include <string>

namespace
{
// Returns the refusal of a value by the check; empty if the check accepts it.
std::string Refusal(std::string value)
{
    return Common::NumberWithin({0.1, 40})(value);
}

TEST(NumberWithin, TakesNumbersOfTheRange)
{
    for (const char *value : {"0.1", "40", "4e1", " 1.5"})
        EXPECT_EQ(Refusal(value), "") << value;
}

TEST(NumberWithin, RefusesNumbersOutsideAndWhatIsNoNumber)
{
    EXPECT_EQ(Refusal("41"), "it must be from 0.1 to 40, not 41");
    EXPECT_EQ(Refusal("nan"), "it must be from 0.1 to 40, not nan");
    EXPECT_EQ(Refusal("1e999"), "it must be from 0.1 to 40, not inf");
    for (const char *value : {"", "x", "1x", "1 "})
        EXPECT_EQ(Refusal(value), "expected a number, found '" + std::string(value) + "'");
}

}  // namespace
