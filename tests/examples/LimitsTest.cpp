#include "Limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace
{
constexpr double Nan = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

TEST(Limits, BothEndsOfARangeBelongToIt)
{
    constexpr Common::Range range{-2, 3};
    EXPECT_TRUE(range.Contains(-2));
    EXPECT_TRUE(range.Contains(3));
    EXPECT_FALSE(range.Contains(std::nextafter(-2, -Infinity)));
    EXPECT_FALSE(range.Contains(std::nextafter(3, Infinity)));
}

TEST(Limits, NothingThatIsNoFiniteNumberIsWithinThem)
{
    for (const double value : {Nan, -Nan, Infinity, -Infinity})
        EXPECT_FALSE(Common::LatitudeDeg.Contains(value)) << value;
}

TEST(Limits, ARefusalSaysWhatIsWrongAndWhatIsAllowed)
{
    EXPECT_EQ(Common::WhyNot("north_m", 400.0, Common::SideM), "");
    EXPECT_EQ(Common::WhyNot("north_m", 5.0, Common::SideM), "north_m must be from 10 to 20000, not 5");
    EXPECT_EQ(Common::WhyNot("x", Nan, Common::LatitudeDeg), "x must be from -90 to 90, not nan");
    EXPECT_EQ(Common::WhyNot("x", 90.00000001, Common::LatitudeDeg),
              "x must be from -90 to 90, not 90.00000001");
    EXPECT_EQ(Common::WhyNot("x", 50.1F, Common::SpeedMps), "x must be from 0.1 to 50, not 50.1");
}

TEST(Limits, WhatIsWithinThemAsADoubleIsSoAsAFloat)
{
    for (const Common::Range &range : {Common::AltitudeM, Common::SpeedMps, Common::SideM, Common::LaneM})
        for (const double end : {range.Lowest, range.Highest})
            EXPECT_TRUE(range.Contains(static_cast<float>(end))) << end;
}

}  // namespace
