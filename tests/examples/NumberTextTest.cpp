#include "NumberText.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace
{
using Ground::BytesPerSecondText;
using Ground::KiloText;
using Ground::MillisecondsText;
using Ground::PerSecondText;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Huge = std::numeric_limits<double>::max();

TEST(NumberText, HasTheUnitThatFits)
{
    EXPECT_EQ(BytesPerSecondText(0), "0 B/s");
    EXPECT_EQ(BytesPerSecondText(850.4), "850 B/s");
    EXPECT_EQ(BytesPerSecondText(999.6), "1.0 kB/s");
    EXPECT_EQ(BytesPerSecondText(3210), "3.2 kB/s");
    EXPECT_EQ(BytesPerSecondText(999'960), "1.0 MB/s");
    EXPECT_EQ(BytesPerSecondText(1.54e6), "1.5 MB/s");
}

TEST(NumberText, HasFewDigits)
{
    EXPECT_EQ(KiloText(90), "0.09");
    EXPECT_EQ(KiloText(9996), "10.0");
    EXPECT_EQ(KiloText(340'400), "340");
    EXPECT_EQ(PerSecondText(6.24), "6.2");
    EXPECT_EQ(PerSecondText(250.2), "250");
    EXPECT_EQ(MillisecondsText(0.00091), "0.9");
    EXPECT_EQ(MillisecondsText(0.0124), "12");
    EXPECT_EQ(MillisecondsText(1.5), "1500");
}

TEST(NumberText, SaysThatItIsNotKnownOfWhatIsNoNumber)
{
    for (const double value : {NaN, Infinity, -Infinity, -1.0})
    {
        EXPECT_EQ(BytesPerSecondText(value), "-");
        EXPECT_EQ(KiloText(value), "-");
        EXPECT_EQ(PerSecondText(value), "-");
        EXPECT_EQ(MillisecondsText(value), "-");
    }
}

TEST(NumberText, StaysShortWhateverTheNumberIs)
{
    EXPECT_EQ(BytesPerSecondText(Huge), ">99999 MB/s");
    EXPECT_EQ(KiloText(Huge), ">99999");
    EXPECT_EQ(PerSecondText(Huge), ">99999");
    EXPECT_EQ(MillisecondsText(1e300), ">99999");
    EXPECT_EQ(MillisecondsText(Huge), ">99999");
}

}  // namespace
