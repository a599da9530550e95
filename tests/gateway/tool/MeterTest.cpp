#include "Meter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Rabit::Tool
{
namespace
{

TEST(Meter, RateAndGapsAreThoseBetweenTheValues)
{
    Meter meter;
    for (const double at : {1.0, 1.1, 1.3, 1.4})
    {
        meter.Add(at, 50, 0.0);
    }
    EXPECT_EQ(meter.Count(), 4u);
    EXPECT_NEAR(meter.Rate(), 7.5, 1e-9);
    EXPECT_NEAR(meter.ShortestGap(), 0.1, 1e-9);
    EXPECT_NEAR(meter.LongestGap(), 0.2, 1e-9);
    EXPECT_NEAR(meter.Jitter(), std::sqrt(2.0) / 30.0, 1e-9);
}

TEST(Meter, OfOneValueThereIsNoRate)
{
    Meter meter;
    EXPECT_TRUE(std::isnan(meter.MeanBytes()) && std::isnan(meter.Age(0.5)));
    meter.Add(1.0, 50, 0.25);
    EXPECT_TRUE(std::isnan(meter.Rate()) && std::isnan(meter.Jitter()) && std::isnan(meter.LongestGap()));
    EXPECT_EQ(meter.MeanBytes(), 50.0);
    EXPECT_EQ(meter.Age(0.5), 0.25);
}

TEST(Meter, AnAgeIsThatWhichSoManyDidNotExceed)
{
    Meter meter;
    for (int i = 100; i >= 1; --i)
    {
        meter.Add(200.0 - i, 1, i);
    }
    EXPECT_EQ(meter.Age(0.5), 50.0);
    EXPECT_EQ(meter.Age(0.99), 99.0);
    EXPECT_EQ(meter.Age(1.0), 100.0);
    EXPECT_EQ(meter.Age(0.0), 1.0);
}

}  // namespace
}  // namespace Rabit::Tool
